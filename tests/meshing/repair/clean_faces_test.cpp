#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "meshing/repair/repair_sentence.h"
#include "tests/support/expect_error.h"
#include "tests/support/repair_scenes.h"

#include <gmock/gmock.h>
#include <vector>

// Faces that are none, or that are drawn in odd ways.

namespace halfshade {
namespace {

using test::count;
using test::only;
using test::rectangle;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MakeSound, DropsFacesWithoutAreaAndRepeatedOnes) {
  Scene scene = scene_of({{rectangle(0, 0, 1, 1), 0},
                          {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 0},
                          {rectangle(0, 0, 1, 1e-12, 3), 0},
                          {{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1},
                          {{{1, 0, 4}, {1, 0, 4}, {1, 0, 4}}, 1}});
  scene.faces[3].line = 31;
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].material, 0);
  EXPECT_EQ(count(sound, Repair::Kind::degenerate_dropped), 3);
  EXPECT_THAT(only(sound, Repair::Kind::duplicate_dropped).faces, ElementsAre(3, 0));
  EXPECT_THAT(sentence(only(sound, Repair::Kind::duplicate_dropped), sound),
              testing::AllOf(HasSubstr("face 4 (line 31)"), HasSubstr("face 1")));
}

TEST(MakeSound, ARepeatedFaceThatEmitsIsTheOneThatStays) {
  const auto square = rectangle(0, 0, 1, 1);
  const SoundScene sound = make_sound(scene_of({{square, 0}, {square, 2}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].material, 2);
}

TEST(MakeSound, RepeatedCornersAndSpikesBoundNothing) {
  const SoundScene sound = make_sound(scene_of(
      {{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}},
        0},
       {{{3, 0, 0}, {6, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}}, 0}}));
  ASSERT_EQ(sound.surfaces.size(), 2u);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[0]), 1);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[1]), 1);
}

TEST(MakeSound, AHoleCutInByABridgeBecomesAHole) {
  const SoundScene sound = make_sound(scene_of({{{{0, 0, 0},
                                                  {3, 0, 0},
                                                  {3, 3, 0},
                                                  {0, 3, 0},
                                                  {0, 0, 0},
                                                  {1, 1, 0},
                                                  {1, 2, 0},
                                                  {2, 2, 0},
                                                  {2, 1, 0},
                                                  {1, 1, 0}},
                                                 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings.size(), 2u);
  EXPECT_DOUBLE_EQ(total_area(sound), 8);
}

TEST(MakeSound, NothingWithAnAreaIsAnError) {
  test::expect_error(
      [] {
        make_sound(scene_of({{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0}}));
      },
      ErrorCode::invalid_input, {"test.obj", "area"});
}

}  // namespace
}  // namespace halfshade
