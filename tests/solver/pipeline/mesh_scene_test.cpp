#include "solver/pipeline/mesh_scene.h"

#include "meshing/core/error.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "tests/support/expect_error.h"
#include "tests/support/room_families.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

TEST(MeshScene, LabelsEveryElementForEverySource) {
  MeshOptions options;
  options.max_length = 0.2;
  const MeshResult result = mesh_scene(test::table_scene(), options);
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
  const MeshResult result = mesh_scene(test::table_scene());
  Eigen::Array3d areas = Eigen::Array3d::Zero();
  for (std::size_t e = 0; e < result.elements.corners.size(); ++e)
    areas[result.elements.surface[e]] += result.elements.area[e];
  EXPECT_NEAR(areas[0], 4, 1e-11);
  EXPECT_NEAR(areas[1], 1, 1e-11);
  EXPECT_NEAR(areas[2], 0.25, 1e-11);
}

TEST(MeshScene, ReportsItsStages) {
  const MeshResult result = mesh_scene(test::table_scene());
  std::vector<std::string> names;
  for (const StageReport& stage : result.stages) names.push_back(stage.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"repair", "sources", "discontinuities", "mesh", "regions"}));
  EXPECT_EQ(result.stages[2].count, result.found.curves.size());
  MeshOptions options;
  options.with_elements = false;
  const MeshResult curves = mesh_scene(test::table_scene(), options);
  EXPECT_EQ(curves.elements.count(), 0);
  EXPECT_EQ(curves.found.curves.size(), result.found.curves.size());
  EXPECT_EQ(curves.stages.back().left_out_because, "only the curves were asked for");
}

TEST(MeshScene, TheToleranceIsAShareOfTheMeanIrradiance) {
  MeshOptions options;
  options.tolerance = 0.05;
  const MeshResult result = mesh_scene(test::table_scene(), options);
  EXPECT_NEAR(result.irradiance_tolerance,
              0.05 * mean_direct_irradiance(PreparedScene(test::table_scene())), 1e-15);
  EXPECT_GT(result.irradiance_tolerance, 0);
  EXPECT_EQ(mesh_scene(test::table_scene()).irradiance_tolerance, 0);
}

TEST(MeshScene, FollowsTheCurvesThatMatterMostWhereNotAllElementsCanBeLabelled) {
  MeshOptions options;
  options.tolerance = 1e-4;
  const MeshResult all = mesh_scene(test::furnished_room(50), options);
  std::size_t last = all.mesh.kept;
  for (const double work : {1e4, 5e3}) {
    options.label_work = work;
    const MeshResult result = mesh_scene(test::furnished_room(50), options);
    EXPECT_LT(result.mesh.kept, last);
    EXPECT_LT(result.elements.count(), all.elements.count());
    EXPECT_GT(result.irradiance_tolerance, all.irradiance_tolerance) << "as used";
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_EQ(result.warnings.back().kind, Warning::Kind::curves_left_out);
    EXPECT_NE(result.warnings.back().sentence.find("can be labelled"), std::string::npos);
    last = result.mesh.kept;
  }
  options.label_work = 1;
  test::expect_error([&] { mesh_scene(test::furnished_room(50), options); }, ErrorCode::too_large,
                     {"can be labelled"});
}

TEST(MeshScene, StopsWithAValidPartialResult) {
  std::stop_source stop;
  stop.request_stop();
  const MeshResult result = mesh_scene(test::table_scene(), {}, {stop.get_token(), {}});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.region.size(), result.elements.corners.size());
  EXPECT_EQ(result.regions.size(), result.elements.corners.size());
}

TEST(MeshScene, RefusesOptionsOutOfRange) {
  for (const auto& change : std::vector<void (*)(MeshOptions&)>{
           [](MeshOptions& o) { o.tolerance = -1; },
           [](MeshOptions& o) { o.tolerance = std::nan(""); },
           [](MeshOptions& o) { o.max_length = -1; }, [](MeshOptions& o) { o.label_work = -1; },
           [](MeshOptions& o) { o.secondary = -1; }}) {
    MeshOptions options;
    change(options);
    test::expect_error([&] { mesh_scene(test::table_scene(), options); }, ErrorCode::contract,
                       {"mesh_scene", "must be"});
  }
  Scene dark = test::table_scene();
  dark.materials[1].exitance = Rgb::Zero();
  test::expect_error([&] { mesh_scene(dark); }, ErrorCode::invalid_input, {"emit"});
}

}  // namespace
}  // namespace halfshade
