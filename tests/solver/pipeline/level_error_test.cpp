#include "solver/pipeline/level_error.h"

#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/solve.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// A room that hardly absorbs, with a lamp below the ceiling whose back swallows what gets there.
Scene white_room() {
  std::array<std::pair<double, double>, 6> walls;
  walls.fill({0.998, 0});
  Scene scene = test::room({2, 3, 2.5}, walls);
  constexpr double z = 2.4;
  test::add_polygon(scene, {{0.6, 1, z}, {0.6, 1.7, z}, {1.4, 1.7, z}, {1.4, 1, z}},
                    test::add_material(scene, 0.9, 1));
  return scene;
}

/// Of the light in the middles of elements, relative to `right`.
double off(const SolveResult& result, const SolveResult& right) {
  std::vector<SurfacePoint> middles;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto [a, b, c] = result.elements.triangle(e);
    middles.push_back({(a + b + c) / 3, result.elements.normal[at(e)]});
  }
  const std::vector<PointLight> light = light_at_points(right, middles);
  double difference = 0, all = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const double H = light[at(e)].irradiance[0], area = result.elements.area[at(e)];
    difference += area * std::pow(result.solution.irradiance(e, 0) - H, 2);
    all += area * H * H;
  }
  return std::sqrt(difference / all);
}

double mean_on_floor(const SolveResult& result) {
  std::vector<SurfacePoint> points;
  for (double x = 0.1; x < 2; x += 0.2)
    for (double y = 0.1; y < 3; y += 0.2) points.push_back({{x, y, 0}, {0, 0, 1}});
  double sum = 0;
  for (const PointLight& light : light_at_points(result, points)) sum += light.irradiance[0];
  return sum / static_cast<double>(points.size());
}

// A path tracer finds a mean of 1.807 ± .008 on the floor.
TEST(LevelError, KnowsThatLostLightIsMissingEverywhere) {
  const Scene scene = white_room();
  SolveOptions options;
  options.tolerance = 5e-3;
  const SolveResult right = solve(scene, options);
  ASSERT_TRUE(right.not_reached.empty());
  EXPECT_NEAR(mean_on_floor(right), 1.807, 0.02);
  options.method = SolveMethod::matrix;
  for (const int elements : {300, 1000}) {
    options.elements = elements;
    const SolveResult result = solve(scene, options);
    const double error = off(result, right);
    EXPECT_GT(error, 0.05);
    EXPECT_GT(result.relative_error, 0.9 * error) << elements;
    EXPECT_LT(result.relative_error, 3 * error) << elements;
  }
}

TEST(LevelError, IsNoneInClosedRooms) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 300;
  const Scene scene = test::lit_cube({.9, .9, .9, .9, .9, .9});
  const SolveResult result = solve(scene, options);
  Exchange exchange;
  const Eigen::Index count = result.elements.count();
  exchange.area = Eigen::Map<const Eigen::ArrayXd>(result.elements.area.data(), count);
  exchange.lost = Eigen::ArrayXd::LinSpaced(count, 0, 1) * exchange.area;
  exchange.enclosures = {std::vector<int>(at(result.elements.count()), 0), {true}, {true}};
  const MaterialArrays materials{ChannelArray::Constant(count, 3, 0.9),
                                 ChannelArray::Constant(count, 3, 1)};
  const auto error = [&] {
    return level_error(result.elements, exchange, materials, result.solution.irradiance).maxCoeff();
  };
  EXPECT_EQ(error(), 0);
  exchange.enclosures.closed[0] = false;
  EXPECT_GT(error(), 0);
}

}  // namespace
}  // namespace halfshade
