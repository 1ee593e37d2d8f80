#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/cornell.h"
#include "tests/support/element_points.h"
#include "tests/support/expect_error.h"
#include "tests/support/random.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

namespace halfshade {
namespace {

SolveOptions within(double tolerance, FinalGather gather) {
  SolveOptions options;
  options.tolerance = tolerance;
  options.final_gather = gather;
  return options;
}

bool has_gathered(const SolveResult& result) {
  return std::any_of(result.stages.begin(), result.stages.end(), [](const StageReport& stage) {
    return stage.name == "final gather" && stage.left_out_because.empty();
  });
}

/// Mean square, of reflected light alone.
double off(const SolveResult& result, std::span<const SurfacePoint> points,
           std::span<const PointLight> truth) {
  double sum = 0;
  const std::vector<PointLight> light = light_at_points(result, points);
  for (std::size_t k = 0; k < points.size(); ++k)
    sum += (light[k].irradiance - light[k].direct_irradiance - truth[k].irradiance +
            truth[k].direct_irradiance)
               .square()
               .sum();
  return sum / static_cast<double>(points.size());
}

// Against a solution ten times as exact.
TEST(FinalGather, IsMoreExactThanThePolynomials) {
  const PreparedScene prepared(test::cornell_box());
  const SolveResult fine = solve(prepared, within(2e-3, FinalGather::off));
  test::Random random(11);
  std::vector<SurfacePoint> points;
  for (const auto& [surface, point] : test::spread_points(fine.elements, 1000, random))
    points.push_back(point);
  const std::vector<PointLight> truth = light_at_points(fine, points);
  for (const ReflectedVisibility visibility :
       {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
    SolveOptions options = within(2e-2, FinalGather::off);
    options.visibility = visibility;
    const SolveResult polynomials = solve(prepared, options);
    options.final_gather = FinalGather::on;
    const SolveResult gathered = solve(prepared, options);
    EXPECT_FALSE(has_gathered(polynomials));
    EXPECT_TRUE(has_gathered(gathered));
    EXPECT_EQ(gathered.reflected.error, polynomials.reflected.error) << "what is claimed is theirs";
    EXPECT_LT(off(gathered, points, truth), 0.8 * off(polynomials, points, truth));
  }
}

TEST(FinalGather, IsAutomaticWhereTheToleranceIsNotReached) {
  const PreparedScene prepared(test::lit_cube({.8, .8, .8, .8, .8, .8}));
  SolveOptions options = within(5e-2, FinalGather::automatic);
  EXPECT_FALSE(has_gathered(solve(prepared, options)));
  options.tolerance = 1e-3;
  options.max_elements = 150;
  const SolveResult limited = solve(prepared, options);
  EXPECT_EQ(limited.reflected.end, ReflectedEnd::elements);
  EXPECT_TRUE(has_gathered(limited));
}

TEST(FinalGather, IsLeftOutWhereItTakesLongerThanTheSolution) {
  SolveOptions options = within(1e-3, FinalGather::automatic);
  options.max_elements = 1000;
  const SolveResult result = solve(test::cornell_box(), options);
  EXPECT_EQ(result.reflected.end, ReflectedEnd::elements);
  const auto stage = std::ranges::find(result.stages, "final gather", &StageReport::name);
  ASSERT_NE(stage, result.stages.end());
  EXPECT_NE(stage->left_out_because.find("times as long"), std::string::npos);
}

TEST(FinalGather, GoesWithAllLightOnly) {
  SolveOptions options = within(0.1, FinalGather::on);
  const auto run = [&] { solve(test::cornell_box(), options); };
  options.radiosity.bounces = 1;
  test::expect_error(run, ErrorCode::usage, {"all bounces"});
  options.radiosity.bounces = -1;
  options.method = SolveMethod::matrix;
  test::expect_error(run, ErrorCode::usage, {"--method fields"});
}

}  // namespace
}  // namespace halfshade
