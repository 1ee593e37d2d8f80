#include "meshing/repair/repair.h"

#include "meshing/repair/repair_sentence.h"
#include "tests/support/cornell.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>

// Whole scenes.

namespace halfshade {
namespace {

using test::contact_length;
using test::expect_surfaces_sound;
using test::only;
using test::rectangle;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MakeSound, RoomStaysAsItIs) {
  const Scene scene = test::room({3, 4, 2.5}, {});
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 6u);
  EXPECT_TRUE(sound.repairs.empty());
  expect_surfaces_sound(sound);
  for (std::size_t r = 0; r < 6; ++r) {
    const Surface& surface = sound.surfaces[r];
    EXPECT_THAT(surface.faces, ElementsAre(static_cast<int>(r)));
    EXPECT_TRUE(surface.contacts.empty());
    // Looks into the room, and its corners are the input's.
    EXPECT_GT(surface.frame.height({1.5, 2, 1.25}), 0);
    const std::vector<Vec3> corners = face_corners(scene, static_cast<int>(r));
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT((surface.frame.to_space(surface.rings[0][k]) - corners[k]).norm(), 1e-14);
  }
}

TEST(MakeSound, CornellBox) {
  const SoundScene sound = make_sound(test::cornell_box());
  expect_surfaces_sound(sound);
  EXPECT_EQ(sound.surfaces.size(), 17u);  // the red wall is 3.2 mm off plane: two triangles
  EXPECT_THAT(only(sound, Repair::Kind::non_planar_triangulated).faces, ElementsAre(5));
  EXPECT_THAT(sentence(only(sound, Repair::Kind::non_planar_triangulated), sound),
              HasSubstr("face 6"));
  EXPECT_THAT(only(sound, Repair::Kind::overlap_removed).faces, ElementsAre(1, 2));
  const Surface &light = sound.surfaces[1], &ceiling = sound.surfaces[2];
  EXPECT_DOUBLE_EQ(area(light), 130 * 105);
  EXPECT_DOUBLE_EQ(area(ceiling), 556 * 559.2 - 130 * 105);
  EXPECT_EQ(ceiling.rings.size(), 2u);
  EXPECT_EQ(light.plane, ceiling.plane);
  // The blocks stand on the floor: four edges each.
  const Surface& floor = sound.surfaces[0];
  EXPECT_EQ(floor.contacts.size(), 8u);
  EXPECT_NEAR(test::length_of(floor.contacts), contact_length(sound), 1e-9);
  double expected = 0;
  const std::vector<std::vector<Vec2>> blocks = {{{130, 65}, {82, 225}, {240, 272}, {290, 114}},
                                                 {{423, 247}, {265, 296}, {314, 456}, {472, 406}}};
  for (const auto& block : blocks) expected += test::perimeter_of({block});
  EXPECT_NEAR(contact_length(sound), expected, 1e-9);
}

TEST(MakeSound, TwoSidedFacesBecomeFrontAndBack) {
  const SoundScene sound =
      make_sound(scene_of({{rectangle(0, 0, 1, 2), 3}, {rectangle(0, 0, 1, 2, 5), 0}}));
  ASSERT_EQ(sound.surfaces.size(), 3u);
  const Surface &front = sound.surfaces[0], &back = sound.surfaces[1];
  EXPECT_FALSE(front.back);
  EXPECT_TRUE(back.back);
  EXPECT_EQ(front.plane, back.plane);
  EXPECT_LT((front.frame.normal + back.frame.normal).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(area(front), 2);
  EXPECT_DOUBLE_EQ(area(back), 2);
  expect_surfaces_sound(sound);
}

// What a scene is must not depend on where it lies, how large it is or how its faces are ordered.
struct Numbers {
  std::size_t surfaces, contacts, repairs;
  double area, contact_length;
};

Numbers numbers(const SoundScene& scene) {
  Numbers result{scene.surfaces.size(), 0, scene.repairs.size(), total_area(scene),
                 contact_length(scene)};
  for (const Surface& surface : scene.surfaces) result.contacts += surface.contacts.size();
  return result;
}

void expect_same(const Numbers& a, const Numbers& b, double scale) {
  EXPECT_EQ(a.surfaces, b.surfaces);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.repairs, b.repairs);
  EXPECT_NEAR(a.area * scale * scale / b.area, 1, 1e-9);
  EXPECT_NEAR(a.contact_length * scale / b.contact_length, 1, 1e-9);
}

class Moved : public testing::TestWithParam<int> {};

TEST_P(Moved, SceneIsTheSame) {
  const int seed = GetParam();
  const Scene scene = test::cornell_box();
  const Numbers expected = numbers(make_sound(scene));
  const Vec3 axis = Vec3(1 + seed, 2 - seed, 0.5 * seed).normalized();
  const Eigen::AngleAxisd turn(0.7 + seed, axis);
  const double scale = std::pow(10.0, 6 * seed - 12);
  Scene moved = scene;
  for (Vec3& p : moved.vertices) p = scale * (turn * p + Vec3(1000, -200 * seed, 30));
  std::rotate(moved.faces.begin(), moved.faces.begin() + 3 * seed, moved.faces.end());
  const SoundScene sound = make_sound(moved);
  expect_same(expected, numbers(sound), scale);
  expect_surfaces_sound(sound);
}

INSTANTIATE_TEST_SUITE_P(Motions, Moved, testing::Range(0, 5));

}  // namespace
}  // namespace halfshade
