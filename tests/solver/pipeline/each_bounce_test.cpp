#include "solver/pipeline/linear_result.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "solver/reference/reference_light.h"
#include "tests/support/cornell.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

SolveOptions told_apart(int bounces, double tolerance = 0.01) {
  SolveOptions options;
  options.radiosity.bounces = bounces;
  options.each_bounce = true;
  options.tolerance = tolerance;
  return options;
}

double norm(const ElementField& field, const ElementTable& elements) {
  return std::sqrt(square_integral(field, elements));
}

TEST(EachBounce, AddsUpToAllLight) {
  for (const auto visibility : {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
    SolveOptions options = told_apart(3, 0.03);
    options.visibility = visibility;
    const SolveResult result = solve(test::cornell_box(), options);
    ASSERT_EQ(result.bounces.size(), 3U);
    const NodeValues nodes = node_values(result);
    ASSERT_EQ(nodes.bounces.size(), 4U);
    ChannelArray sum = nodes.bounces[0];
    for (std::size_t k = 1; k < nodes.bounces.size(); ++k) sum += nodes.bounces[k];
    EXPECT_LT((sum - nodes.irradiance).abs().maxCoeff(), 1e-12 * sum.maxCoeff());
    const LinearResult linear = linear_result(result);
    ASSERT_EQ(linear.bounces.size(), 4U);
    EXPECT_EQ(linear.bounces[3].rows(), linear.irradiance.rows());
  }
}

/// All of a furnace is alike: E, ρ E, ρ² E, ...
TEST(EachBounce, FallsByTheReflectanceInAFurnace) {
  const double rho = 0.6;
  const std::pair<double, double> wall(rho, 1);
  const SolveResult result =
      solve(test::room({1, 1, 1}, {wall, wall, wall, wall, wall, wall}), told_apart(4));
  EXPECT_TRUE(result.reflected.through_operator);
  ASSERT_EQ(result.bounces.size(), 4U);
  EXPECT_LT((means(result.direct) - 1).abs().maxCoeff(), 1e-6);
  for (int k = 1; k <= 4; ++k)
    EXPECT_LT((means(result.bounces[at(k - 1)]) - std::pow(rho, k)).abs().maxCoeff(), 1e-6) << k;
}

/// Each is what random walks of so many reflections find more than those of one less.
TEST(EachBounce, IsWhatRandomWalksFind) {
  const PreparedScene prepared(test::cornell_box());
  const int bounces = 3;
  for (const auto visibility : {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
    SolveOptions options = told_apart(bounces);
    options.visibility = visibility;
    const SolveResult result = solve(prepared, options);
    std::vector<ReferencePoint> points;
    std::vector<int> elements;
    for (int e = 0; e < result.elements.count(); e += result.elements.count() / 150 + 1) {
      const auto [a, b, c] = result.elements.triangle(e);
      points.push_back({(a + b + c) / 3, result.elements.normal[at(e)]});
      elements.push_back(e);
    }
    ReferenceOptions walks;
    walks.samples = 2048;
    ReferenceLight before;
    const double all =
        norm(result.irradiance, result.elements) /
        std::sqrt(std::accumulate(result.elements.area.begin(), result.elements.area.end(), 0.));
    for (int k = 0; k <= bounces; ++k) {
      walks.bounces = k;
      const ReferenceLight light = reference_light(prepared.scene(), points, walks);
      if (k > 0) {
        double square = 0, noise = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Rgb here =
              value_at(result.bounces[at(k - 1)], elements[i], TrianglePlace::Constant(1. / 3));
          square += (here - light.values[i].total + before.values[i].total).square().sum();
          noise +=
              (light.standard_errors[i].total.square() + before.standard_errors[i].total.square())
                  .sum();
        }
        const auto count = static_cast<double>(points.size());
        EXPECT_LT(std::sqrt(square / count), options.tolerance * all + std::sqrt(noise / count))
            << k;
        EXPECT_GT(norm(result.bounces[at(k - 1)], result.elements), 3 * std::sqrt(noise / count));
      }
      before = light;
    }
  }
}

TEST(EachBounce, IsZeroWhereNothingReflects) {
  const std::pair<double, double> black(0, 0), lamp(0, 1);
  const SolveResult result =
      solve(test::room({1, 1, 1}, {black, black, black, black, black, lamp}), told_apart(2));
  ASSERT_EQ(result.bounces.size(), 2U);
  EXPECT_EQ(result.bounces[1].coefficients.abs().maxCoeff(), 0);
  EXPECT_EQ(node_values(result).bounces.size(), 3U);
}

TEST(EachBounce, TakesANumberOfBounces) {
  for (const int bounces : {-1, 0, 101})
    test::expect_error([&] { solve(test::cornell_box(), told_apart(bounces)); }, ErrorCode::usage,
                       {"--each-bounce"});
  SolveOptions matrix = told_apart(2);
  matrix.method = SolveMethod::matrix;
  test::expect_error([&] { solve(test::cornell_box(), matrix); }, ErrorCode::usage,
                     {"--each-bounce"});
}

}  // namespace
}  // namespace halfshade
