#include "solver/pipeline/plan.h"

#include "meshing/repair/repair.h"
#include "solver/pipeline/sources.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

Plan plan_of(const Scene& scene, const SolveOptions& options, std::vector<StageReport>& reports) {
  Stages stages(reports);
  return make_plan(PreparedScene(scene), options, {}, stages);
}

TEST(Plan, FindsSourcesAndTheirMeanIrradiance) {
  std::vector<StageReport> reports;
  const Plan plan = plan_of(test::table_scene(), {}, reports);
  EXPECT_EQ(plan.no_discontinuities, "");
  EXPECT_EQ(plan.no_exact_direct_light, "");
  ASSERT_EQ(plan.sources.size(), 1u);
  EXPECT_EQ(plan.sources[0].surface, 1);
  EXPECT_EQ(plan.mean_irradiance, mean_direct_irradiance(PreparedScene(test::table_scene())));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].name, "sources");
  EXPECT_EQ(reports[0].count, 1u);
}

TEST(Plan, SaysWhyThereIsNoNeedOfDiscontinuities) {
  std::vector<StageReport> reports;
  SolveOptions options;
  EXPECT_EQ(plan_of(test::lit_cube({0, 0, 0, 0, 0, 0}), options, reports).no_discontinuities,
            "no surface can come between two others");
  options.discontinuities = false;
  EXPECT_EQ(plan_of(test::table_scene(), options, reports).no_discontinuities,
            "they were not asked for");
  options = {};
  options.events = {false, false, false, false};
  EXPECT_EQ(plan_of(test::table_scene(), options, reports).no_discontinuities,
            "they were not asked for");
  EXPECT_TRUE(reports.empty()) << "nothing had to be computed";
  options = {};
  options.tolerance = 1;
  const Plan weak = plan_of(test::table_scene(), options, reports);
  EXPECT_EQ(weak.no_discontinuities, "no source gives more than the tolerance of all light");
  EXPECT_EQ(weak.mean_irradiance, 0);
}

TEST(Plan, SaysWhyDirectLightIsNotExact) {
  std::vector<StageReport> reports;
  SolveOptions options;
  options.direct_light = DirectLightBy::matrix;
  EXPECT_EQ(plan_of(test::table_scene(), options, reports).no_exact_direct_light,
            "the matrix was asked for");
  Scene furnace = test::table_scene();
  for (Material& material : furnace.materials) material.exitance = Rgb::Ones();
  EXPECT_EQ(plan_of(furnace, {}, reports).no_exact_direct_light,
            most_surfaces_emit(make_sound(furnace)));
  options.direct_light = DirectLightBy::exact;
  EXPECT_EQ(plan_of(furnace, options, reports).no_exact_direct_light, "");
}

TEST(MeanDirectIrradiance, IsThePowerOverTheAreaItReaches) {
  // All that the ceiling sends arrives on the five other faces.
  EXPECT_NEAR(mean_direct_irradiance(PreparedScene(test::lit_cube({0, 0, 0, 0, 0, 0}))), 0.2, 1e-3);
  // A face behind the light does not count.
  Scene scene = test::lit_cube({0, 0, 0, 0, 0, 0});
  test::add_polygon(scene, {{0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}}, 0);
  EXPECT_NEAR(mean_direct_irradiance(PreparedScene(scene)), 0.2, 1e-3);
}

TEST(IsConvex, HoldsForEmptyRoomsOnly) {
  const auto convex = [](const Scene& scene) { return is_convex(make_sound(scene)); };
  EXPECT_TRUE(convex(test::lit_cube({0, 0, 0, 0, 0, 0})));
  Scene turned = test::lit_cube({0, 0, 0, 0, 0, 0});
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : turned.vertices) p = 1e3 * (turn * p) + Vec3(1e3, 0, 0);
  EXPECT_TRUE(convex(turned));
  EXPECT_FALSE(convex(test::l_room(false)));
  EXPECT_FALSE(convex(test::table_scene()));
}

}  // namespace
}  // namespace halfshade
