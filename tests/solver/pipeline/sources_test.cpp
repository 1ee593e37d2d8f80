#include "solver/pipeline/sources.h"

#include "meshing/repair/repair.h"
#include "solver/pipeline/prepared_scene.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(SecondarySources, AreTheSurfacesThatReflectMost) {
  // The floor gets F = 0.1998 from the ceiling, each wall 0.2000, and what the others reflect is
  // small: power goes with the reflectances.
  const PreparedScene scene(test::lit_cube({0.02, 0.01, 0, 0.03, 0.9, 0.9}));
  const auto sources = secondary_sources(scene, 3);
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[0].surface, 4);
  EXPECT_EQ(sources[1].surface, 3);
  EXPECT_EQ(sources[2].surface, 0);
  EXPECT_EQ(secondary_sources(scene, 1).size(), 1u);
  EXPECT_EQ(secondary_sources(scene, 9).size(), 4u)
      << "neither the light, bright as it is, nor the black wall";
}

TEST(SecondarySources, SendWhatTheyReflect) {
  // Parallel unit squares at distance 1: F = 0.199824896; all else black, so B = 0.5 F E.
  const auto sources = secondary_sources(PreparedScene(test::lit_cube({0, 0, 0, 0, 0.5, 0})), 1);
  ASSERT_EQ(sources.size(), 1u);
  EXPECT_NEAR(sources[0].exitance, 0.5 * 0.199824896, 1e-4);
}

TEST(SecondarySources, FollowTheEmitters) {
  const PreparedScene scene(test::lit_cube({0.5, 0, 0, 0, 0, 0}));
  EXPECT_EQ(all_sources(scene, 0).size(), 1u);
  const auto sources = all_sources(scene, 2);
  ASSERT_EQ(sources.size(), 2u) << "nothing else reflects";
  EXPECT_EQ(sources[0].surface, 5);
  EXPECT_EQ(sources[1].surface, 0);
}

TEST(StrongEnough, LeavesOutWhatTheToleranceCovers) {
  // Powers 1, 0.5 and 0.5: the floor's area is 4, the table's 0.25.
  const SoundScene scene = make_sound(test::table_scene());
  const std::vector<LightSource> sources = {{1, 1}, {0, 0.125}, {2, 2}};
  const auto count = [&](double tolerance) {
    return strong_enough(sources, scene, tolerance).size();
  };
  EXPECT_EQ(count(0), 3u);
  EXPECT_EQ(count(0.24), 3u);
  EXPECT_EQ(count(0.25), 1u) << "what gives just the tolerance is within it";
  EXPECT_EQ(strong_enough(sources, scene, 0.3).front().surface, 1);
  EXPECT_EQ(count(0.5), 0u);
}

TEST(MostSurfacesEmit, InAFurnaceButNotUnderALargeFarLight) {
  EXPECT_EQ(most_surfaces_emit(make_sound(test::table_scene())), "");
  Scene furnace = test::room({1, 1, 1}, {});
  for (Material& material : furnace.materials) material.exitance = Rgb::Ones();
  EXPECT_NE(most_surfaces_emit(make_sound(furnace)), "");
  Scene sun = test::table_scene();
  const int bright = test::add_material(sun, 0, 1);
  const double half = 500, height = 1e5;
  test::add_polygon(
      sun,
      {{-half, half, height}, {half, half, height}, {half, -half, height}, {-half, -half, height}},
      bright);
  EXPECT_EQ(most_surfaces_emit(make_sound(sun)), "") << "it is nearly all of the area";
}

}  // namespace
}  // namespace halfshade
