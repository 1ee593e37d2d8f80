#include "solver/pipeline/mesh_scene.h"

#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "tests/support/expect_error.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

/// A unit cube whose ceiling (face 5) emits; reflectances by face.
Scene lit_cube(const std::array<double, 6>& rho) {
  std::array<std::pair<double, double>, 6> faces;
  for (std::size_t f = 0; f < 6; ++f) faces[f] = {rho[f], f == 5 ? 1. : 0.};
  return test::room({1, 1, 1}, faces);
}

/// A floor of 2 × 2 at z = 0, below it nothing; a light of 1 × 1 at z = 2; a table at z = 1.
Scene table_scene() {
  Scene scene;
  const int dark = test::add_material(scene, 0.5, 0), light = test::add_material(scene, 0, 1);
  test::add_polygon(scene, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, dark);
  test::add_polygon(scene, {{-.5, -.5, 2}, {-.5, .5, 2}, {.5, .5, 2}, {.5, -.5, 2}}, light);
  test::add_polygon(scene, {{-.25, -.25, 1}, {.25, -.25, 1}, {.25, .25, 1}, {-.25, .25, 1}}, dark);
  return scene;
}

TEST(MeshScene, LabelsEveryElementForEverySource) {
  MeshOptions options;
  options.max_length = 0.2;
  const MeshResult result = mesh_scene(table_scene(), options);
  const auto n = static_cast<std::size_t>(result.elements.count());
  ASSERT_EQ(result.found.sources.size(), 1u);
  EXPECT_EQ(result.found.sources[0].surface, 1);
  ASSERT_EQ(result.region.size(), n);
  ASSERT_EQ(result.regions.size(), n);
  EXPECT_EQ(result.region, result.regions) << "one source is the strongest";
  double umbra = 0;
  for (std::size_t e = 0; e < n; ++e) {
    if (result.elements.surface[e] == 1) {
      EXPECT_EQ(result.region[e], Region::away);
    }
    if (result.elements.surface[e] == 2) {
      EXPECT_EQ(result.region[e], Region::lit);
    }
    if (result.region[e] == Region::umbra) umbra += result.elements.area[e];
  }
  EXPECT_EQ(umbra, 0) << "the table is half as large as the light, half way: the umbra is a point";
  EXPECT_FALSE(result.interrupted);
}

TEST(MeshScene, CoversEverySurface) {
  const MeshResult result = mesh_scene(table_scene());
  Eigen::Array3d areas = Eigen::Array3d::Zero();
  for (std::size_t e = 0; e < result.elements.corners.size(); ++e)
    areas[result.elements.surface[e]] += result.elements.area[e];
  EXPECT_NEAR(areas[0], 4, 1e-11);
  EXPECT_NEAR(areas[1], 1, 1e-11);
  EXPECT_NEAR(areas[2], 0.25, 1e-11);
}

TEST(MeshScene, ReportsItsStages) {
  const MeshResult result = mesh_scene(table_scene());
  std::vector<std::string> names;
  for (const StageReport& stage : result.stages) names.push_back(stage.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"repair", "sources", "discontinuities", "mesh", "regions"}));
  EXPECT_EQ(result.stages[2].count, result.found.curves.size());
  MeshOptions options;
  options.with_elements = false;
  const MeshResult curves = mesh_scene(table_scene(), options);
  EXPECT_EQ(curves.elements.count(), 0);
  EXPECT_EQ(curves.found.curves.size(), result.found.curves.size());
  EXPECT_EQ(curves.stages.back().left_out_because, "only the curves were asked for");
}

TEST(MeshScene, TheToleranceIsAShareOfTheMeanIrradiance) {
  MeshOptions options;
  options.tolerance = 0.05;
  const MeshResult result = mesh_scene(table_scene(), options);
  EXPECT_NEAR(result.irradiance_tolerance, 0.05 * mean_direct_irradiance(result.scene), 1e-15);
  EXPECT_GT(result.irradiance_tolerance, 0);
  EXPECT_EQ(mesh_scene(table_scene()).irradiance_tolerance, 0);
}

TEST(MeshScene, StopsWithAValidPartialResult) {
  std::stop_source stop;
  stop.request_stop();
  const MeshResult result = mesh_scene(table_scene(), {}, {stop.get_token(), {}});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.region.size(), result.elements.corners.size());
  EXPECT_EQ(result.regions.size(), result.elements.corners.size());
}

TEST(MeshScene, RefusesOptionsOutOfRange) {
  for (const auto& change : std::vector<void (*)(MeshOptions&)>{
           [](MeshOptions& o) { o.tolerance = -1; },
           [](MeshOptions& o) { o.tolerance = std::nan(""); },
           [](MeshOptions& o) { o.max_length = -1; }, [](MeshOptions& o) { o.secondary = -1; }}) {
    MeshOptions options;
    change(options);
    test::expect_error([&] { mesh_scene(table_scene(), options); }, ErrorCode::contract,
                       {"mesh_scene", "must be"});
  }
  Scene dark = table_scene();
  dark.materials[1].exitance = Rgb::Zero();
  test::expect_error([&] { mesh_scene(dark); }, ErrorCode::invalid_input, {"emit"});
}

TEST(MeanDirectIrradiance, IsThePowerOverTheAreaItReaches) {
  // All that the ceiling sends arrives on the five other faces.
  EXPECT_NEAR(mean_direct_irradiance(make_sound(lit_cube({0, 0, 0, 0, 0, 0}))), 0.2, 1e-3);
  // A face behind the light does not count.
  Scene scene = lit_cube({0, 0, 0, 0, 0, 0});
  test::add_polygon(scene, {{0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}}, 0);
  EXPECT_NEAR(mean_direct_irradiance(make_sound(scene)), 0.2, 1e-3);
}

TEST(SecondarySources, AreTheSurfacesThatReflectMost) {
  // The floor gets F = 0.1998 from the ceiling, each wall 0.2000, and what the others reflect is
  // small: power goes with the reflectances.
  const Scene scene = lit_cube({0.02, 0.01, 0, 0.03, 0.9, 0.9});
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
  const auto sources = secondary_sources(lit_cube({0, 0, 0, 0, 0.5, 0}), 1);
  ASSERT_EQ(sources.size(), 1u);
  EXPECT_NEAR(sources[0].exitance, 0.5 * 0.199824896, 1e-4);
}

TEST(SecondarySources, FollowTheEmitters) {
  const Scene scene = lit_cube({0.5, 0, 0, 0, 0, 0});
  const SoundScene sound = make_sound(scene);
  EXPECT_EQ(all_sources(scene, sound, 0).size(), 1u);
  const auto sources = all_sources(scene, sound, 2);
  ASSERT_EQ(sources.size(), 2u) << "nothing else reflects";
  EXPECT_EQ(sources[0].surface, 5);
  EXPECT_EQ(sources[1].surface, 0);
}

TEST(IsConvex, HoldsForEmptyRoomsOnly) {
  const auto convex = [](const Scene& scene) { return is_convex(make_sound(scene)); };
  EXPECT_TRUE(convex(lit_cube({0, 0, 0, 0, 0, 0})));
  Scene turned = lit_cube({0, 0, 0, 0, 0, 0});
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : turned.vertices) p = 1e3 * (turn * p) + Vec3(1e3, 0, 0);
  EXPECT_TRUE(convex(turned));
  EXPECT_FALSE(convex(test::l_room(false)));
  EXPECT_FALSE(convex(table_scene()));
}

}  // namespace
}  // namespace halfshade
