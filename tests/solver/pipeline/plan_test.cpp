#include "solver/pipeline/plan.h"

#include "meshing/repair/repair.h"
#include "solver/pipeline/blockers.h"
#include "solver/pipeline/explain.h"
#include "solver/pipeline/solve.h"
#include "solver/pipeline/sources.h"
#include "tests/support/mean_irradiance.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

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

TEST(MeanDirectIrradiance, IsFoundWhereNearlyAllIsDark) {
  // A lantern that is a millionth of all there is, in a hall that gets none of its light.
  Scene scene = test::lit_cube({0, 0, 0, 0, 0, 0});
  Scene hall = test::lit_cube({0, 0, 0, 0, 0, 0});
  for (const Face& face : hall.faces) {
    std::vector<Vec3> polygon;
    for (const int corner : face.vertices)
      polygon.push_back(1000 * hall.vertices[at(corner)] - Vec3(500, 500, 500));
    test::add_polygon(scene, polygon, 0);
  }
  EXPECT_NEAR(mean_direct_irradiance(PreparedScene(scene)), 0.2, 0.03);
}

TEST(IsConvex, HoldsForEmptyRoomsOnly) {
  const auto convex = [](const Scene& scene) {
    const SoundScene sound = make_sound(scene);
    std::vector<int> all(sound.surfaces.size());
    std::iota(all.begin(), all.end(), 0);
    return is_convex(sound, all);
  };
  EXPECT_TRUE(convex(test::lit_cube({0, 0, 0, 0, 0, 0})));
  Scene turned = test::lit_cube({0, 0, 0, 0, 0, 0});
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : turned.vertices) p = 1e3 * (turn * p) + Vec3(1e3, 0, 0);
  EXPECT_TRUE(convex(turned));
  EXPECT_FALSE(convex(test::l_room(false)));
  EXPECT_FALSE(convex(test::table_scene()));
}

TEST(MakePlan, DoesNotChangeWithTinyThingsBeyondTheWalls) {
  const auto plan_of = [](const Scene& scene) {
    std::vector<StageReport> reports;
    Stages stages(reports);
    return make_plan(PreparedScene(scene), {}, {}, stages);
  };
  for (const bool has_box : {false, true}) {
    Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
    if (has_box)
      for (const auto& face : test::box_faces({.4, .4, .4}, {.6, .6, .6}, false))
        test::add_polygon(scene, face, 0);
    const Plan before = plan_of(scene);
    EXPECT_NE(has_box ? before.no_eee : before.no_discontinuities, "");
    const Vec3 corner(-1, -1, -1);
    test::add_polygon(scene, {corner, corner + Vec3(1e-9, 0, 0), corner + Vec3(0, 1e-9, 0)}, 0);
    const Plan after = plan_of(scene);
    EXPECT_EQ(after.no_eee, before.no_eee);
    EXPECT_EQ(after.no_discontinuities, before.no_discontinuities);
  }
}

/// The largest difference of two solutions on the same elements, relative to the largest light.
double difference(const SolveResult& a, const SolveResult& b) {
  if (a.elements.count() != b.elements.count()) return HUGE_VAL;
  return std::max((a.solution.radiosity - b.solution.radiosity).abs().maxCoeff(),
                  (a.solution.irradiance - b.solution.irradiance).abs().maxCoeff()) /
         a.solution.radiosity.maxCoeff();
}

bool is_left_out(const SolveResult& result, const std::string& name) {
  return std::any_of(result.stages.begin(), result.stages.end(), [&](const StageReport& stage) {
    return stage.name == name && !stage.left_out_because.empty();
  });
}

/// Solves with and without forcing; the stage must be left out in the first case only.
double forced_difference(const Scene& scene, const ForcedStages& force, const std::string& name) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 300;
  options.radiosity.tolerance = 1e-13;
  const SolveResult planned = solve(scene, options);
  EXPECT_TRUE(is_left_out(planned, name)) << name;
  options.force = force;
  const SolveResult forced = solve(scene, options);
  EXPECT_FALSE(is_left_out(forced, name)) << name;
  return difference(planned, forced);
}

TEST(ForcedStages, GiveTheSameAnswer) {
  EXPECT_LE(forced_difference(test::lit_cube({.5, .5, .5, .5, .5, 0}), {.discontinuities = true},
                              "discontinuities"),
            1e-12);
  EXPECT_LE(forced_difference(test::table_scene(), {.eee = true}, "curves at three edges"), 1e-12);
  EXPECT_LE(
      forced_difference(test::lit_cube({0, 0, 0, 0, 0, 0}), {.factors = true}, "form factors"),
      1e-12);
  EXPECT_LE(forced_difference(test::lit_cube({.5, .1, .9, .5, .5, 0}), {.channels = true},
                              "second and third channel"),
            1e-12);
}

/// The same by fields, whose elements need not be the same: the difference of the powers that
/// arrive at the surfaces, in the L2 norm, relative to them.
double forced_difference_of_fields(const Scene& scene, const ForcedStages& force,
                                   const std::string& name) {
  SolveOptions options;
  const auto powers = [&](const SolveResult& result) {
    Eigen::MatrixX3d power =
        Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(result.scene.surfaces.size()), 3);
    for (int e = 0; e < result.elements.count(); ++e)
      power.row(result.elements.surface[at(e)]) +=
          result.elements.area[at(e)] * result.solution.irradiance.row(e).matrix();
    return power;
  };
  const SolveResult planned = solve(scene, options);
  EXPECT_TRUE(is_left_out(planned, name)) << name;
  options.force = force;
  const SolveResult forced = solve(scene, options);
  EXPECT_FALSE(is_left_out(forced, name)) << name;
  return (powers(planned) - powers(forced)).norm() / powers(forced).norm();
}

TEST(ForcedStages, GiveTheSameAnswerByFields) {
  constexpr double tolerance = 0.01;  // by default, of each of the two
  const auto difference = forced_difference_of_fields;
  EXPECT_LE(difference(test::lit_cube({.5, .5, .5, .5, .5, 0}), {.discontinuities = true},
                       "discontinuities"),
            2 * tolerance);
  EXPECT_LE(difference(test::lit_cube({0, 0, 0, 0, 0, 0}), {.factors = true}, "reflected light"),
            2 * tolerance);
  EXPECT_LE(difference(test::lit_cube({.5, .1, .9, .5, .5, 0}), {.channels = true},
                       "second and third channel"),
            1e-12);
  Scene furnace = test::lit_cube({.5, .5, .5, .5, .5, .5});
  for (Material& material : furnace.materials) material.exitance = Rgb::Constant(0.5);
  EXPECT_LE(difference(furnace, {.exact_direct_light = true}, "exact direct light"), 2 * tolerance);
}

SolveResult solve_with_factors(const Scene& scene, Closure closure) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 300;
  options.exchange.closure = closure;
  return solve(scene, options);
}

/// Rays have no switch: something dark that can come between, and is too small to be seen.
TEST(ForcedStages, RaysFindNothingWhereNothingComesBetween) {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, 0});
  const SolveResult planned = solve_with_factors(scene, Closure::automatic);
  EXPECT_TRUE(is_left_out(planned, "visibility rays"));
  const int dark = test::add_material(scene, 0, 0);
  test::add_polygon(scene, {{.5, .5, .5}, {.5001, .5, .5}, {.5, .5001, .5}}, dark);
  const SolveResult forced = solve_with_factors(scene, Closure::automatic);
  EXPECT_FALSE(is_left_out(forced, "visibility rays"));
  EXPECT_NEAR(test::mean_irradiance(planned)[0], test::mean_irradiance(forced)[0],
              1e-3 * test::mean_irradiance(planned)[0]);
}

/// What gets out by a hole a thousandth as wide as a room is within the tolerance, so that rows
/// made to sum to 1 give the same light.
TEST(ForcedStages, ClosureAgreesWhereHardlyAnyLightGetsOut) {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, 0});
  const int wall = scene.faces.front().material;
  for (std::size_t f = 0; f < scene.faces.size(); ++f)
    if (scene.faces[f].material == wall) {
      // One wall in four strips round a hole.
      std::vector<Vec3> c = face_corners(scene, static_cast<int>(f));
      const Vec3 o = c[0], u = c[1] - c[0], v = c[3] - c[0];
      const auto p = [&](double x, double y) { return Vec3(o + x * u + y * v); };
      scene.faces.erase(scene.faces.begin() + static_cast<std::ptrdiff_t>(f));
      const double a = .5, b = .501;
      test::add_polygon(scene, {p(0, 0), p(1, 0), p(1, a), p(0, a)}, wall);
      test::add_polygon(scene, {p(0, b), p(1, b), p(1, 1), p(0, 1)}, wall);
      test::add_polygon(scene, {p(0, a), p(a, a), p(a, b), p(0, b)}, wall);
      test::add_polygon(scene, {p(b, a), p(1, a), p(1, b), p(b, b)}, wall);
      break;
    }
  const SolveResult planned = solve_with_factors(scene, Closure::automatic);
  EXPECT_TRUE(is_left_out(planned, "closure"));
  const SolveResult forced = solve_with_factors(scene, Closure::enforce);
  EXPECT_FALSE(is_left_out(forced, "closure"));
  EXPECT_NEAR(test::mean_irradiance(planned)[0], test::mean_irradiance(forced)[0],
              0.01 * test::mean_irradiance(planned)[0]);
}

TEST(ForcedStages, ExactDirectLightAgreesWithTheMatrix) {
  Scene furnace = test::lit_cube({.5, .5, .5, .5, .5, .5});
  for (Material& material : furnace.materials) material.exitance = Rgb::Constant(0.5);
  EXPECT_LE(forced_difference(furnace, {.exact_direct_light = true}, "exact direct light"), 0.02);
}

TEST(ForcedStages, CurvesOfWeakSourcesAreWithinTheTolerance) {
  Scene scene = test::table_scene();
  const int dim = test::add_material(scene, 0, 1e-4);
  test::add_polygon(scene, {{.7, .7, 2}, {.7, .9, 2}, {.9, .9, 2}, {.9, .7, 2}}, dim);
  const auto power_on_floor = [&](bool force) {
    SolveOptions options;
    options.elements = 600;
    options.force.discontinuities = force;
    const SolveResult result = solve(scene, options);
    EXPECT_EQ(is_left_out(result, "curves of weak sources"), !force);
    double power = 0;
    for (int e = 0; e < result.elements.count(); ++e)
      if (result.elements.surface[at(e)] == 0)
        power += result.elements.area[at(e)] * result.solution.direct_irradiance(e, 0);
    return power;
  };
  const double planned = power_on_floor(false), forced = power_on_floor(true);
  EXPECT_NEAR(planned, forced, 0.01 * forced);
}

TEST(Explain, TellsThePartsOfVeryManyNarrowSurfaces) {
  Scene scene = test::lit_cube({0, 0, 0, 0, 0, 0});
  for (const auto& face : test::box_faces({3, 0, 0}, {4, 1, 1}, true))
    test::add_polygon(scene, face, 0);
  constexpr int across = 20;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const Vec3 low(3.02 + 0.045 * i, 0.02 + 0.045 * j, 0.1);
      for (const auto& face : test::box_faces(low, low + Vec3(0.001, 0.001, 0.8), false))
        test::add_polygon(scene, face, 0);
    }
  const Explanation explanation = explain(PreparedScene(scene), {});
  ASSERT_EQ(explanation.parts.size(), 2u);
  EXPECT_TRUE(explanation.parts[0].closed && explanation.parts[1].closed);
  EXPECT_NE(explanation.parts[0].lit, explanation.parts[1].lit);
}

TEST(Explain, SaysWhatSolveWillLeaveOutAndWhichPartsThereAre) {
  Scene scene = test::lit_cube({0, 0, 0, 0, 0, 0});
  for (const auto& face : test::box_faces({3, 0, 0}, {4, 1, 1}, true))
    test::add_polygon(scene, face, 0);
  const Explanation explanation = explain(PreparedScene(scene), {});
  ASSERT_EQ(explanation.parts.size(), 2u);
  EXPECT_TRUE(explanation.parts[0].closed && explanation.parts[1].closed);
  EXPECT_NE(explanation.parts[0].lit, explanation.parts[1].lit);
  for (const SolveMethod method : {SolveMethod::matrix, SolveMethod::fields}) {
    SolveOptions options;
    options.method = method;
    options.elements = 300;
    options.refine = Refinement::uniform;  // curves are looked for without asking if they pay
    const SolveResult result = solve(scene, options);
    for (const PlannedStage& stage : explain(PreparedScene(scene), options).stages)
      EXPECT_EQ(!stage.left_out_because.empty(), is_left_out(result, stage.name)) << stage.name;
  }
}

TEST(IsOneConvexBody, TellsBodiesFromOpenShells) {
  Scene scene = test::room({4, 4, 4}, {});
  for (const auto& face : test::box_faces({1, 1, 1}, {2, 2, 2}, false))
    test::add_polygon(scene, face, 0);
  SoundScene sound = make_sound(scene);
  EXPECT_EQ(blocking_surfaces(sound).size(), 6u);
  EXPECT_TRUE(is_one_convex_body(sound, blocking_surfaces(sound)));
  scene.faces.pop_back();
  sound = make_sound(scene);
  EXPECT_FALSE(is_one_convex_body(sound, blocking_surfaces(sound)));
  EXPECT_TRUE(is_one_convex_body(sound, {}));
}

}  // namespace
}  // namespace halfshade
