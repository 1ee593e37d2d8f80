#include "solver/pipeline/sources.h"

#include "meshing/repair/repair.h"
#include "solver/pipeline/prepared_scene.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

int face_of(const PreparedScene& prepared, const LightSource& source) {
  return prepared.scene().surfaces[at(source.surface)].faces.front();
}

TEST(SecondarySources, AreTheSurfacesThatReflectMost) {
  // The floor gets F = 0.1998 from the ceiling, each wall 0.2000, and what the others reflect is
  // small: power goes with the reflectances.
  const PreparedScene scene(test::lit_cube({0.02, 0.01, 0, 0.03, 0.9, 0.9}));
  const auto sources = secondary_sources(scene, 3);
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(face_of(scene, sources[0]), 4);
  EXPECT_EQ(face_of(scene, sources[1]), 3);
  EXPECT_EQ(face_of(scene, sources[2]), 0);
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
  EXPECT_EQ(face_of(scene, sources[0]), 5);
  EXPECT_EQ(face_of(scene, sources[1]), 0);
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

TEST(MostSurfacesEmit, ComparesAreasAndNumbers) {
  Scene scene = test::table_scene();  // the light is 1 of 5.25
  EXPECT_EQ(most_surfaces_emit(make_sound(scene)), "");
  Scene furnace = scene;
  furnace.materials[0].exitance = Rgb::Ones();
  EXPECT_NE(most_surfaces_emit(make_sound(furnace)), "");
  test::add_polygon(scene, {{-1e6, 1e6, 1e8}, {1e6, 1e6, 1e8}, {1e6, -1e6, 1e8}, {-1e6, -1e6, 1e8}},
                    1);
  EXPECT_EQ(most_surfaces_emit(make_sound(scene)), "") << "a sun is large, but one";
}

}  // namespace
}  // namespace halfshade
