#include "solver/pipeline/subdivide.h"

#include "meshing/core/error.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/solve.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A room with a lamp of 1 m² flush in its ceiling and a board that shades a part of the floor.
Scene shaded_room() {
  Scene scene = test::room({4, 3, 2}, {{{.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
  const int lamp = test::add_material(scene, 0.5, 24), board = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{1.5, 1, 2}, {1.5, 2, 2}, {2.5, 2, 2}, {2.5, 1, 2}}, lamp);
  test::add_polygon(scene, {{1, .5, 1}, {2, .5, 1}, {2, 2.5, 1}, {1, 2.5, 1}}, board);
  test::add_polygon(scene, {{1, .5, 1}, {1, 2.5, 1}, {2, 2.5, 1}, {2, .5, 1}}, board);
  return scene;
}

SolveOptions constant(int elements, int rounds) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.discontinuities = false;
  options.elements = elements;
  options.subdivision.rounds = rounds;
  return options;
}

/// Root mean square over the floor of what the direct light is off from exact values.
double direct_error(const Scene& scene, const SolveResult& result) {
  const PreparedScene prepared(scene);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 30; ++j)
      points.push_back({{0.05 + 0.0993 * i, 0.05 + 0.0991 * j, 0}, {0, 0, 1}});
  const std::vector<PointLight> found = light_at_points(result, points);
  const std::vector<DirectLight> right = prepared.direct_light().irradiance(points);
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    sum += (found[k].direct_irradiance - right[k].irradiance).square().mean();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(Subdivision, MakesElementsWhereLightIsSteepAndLightThereRight) {
  const Scene scene = shaded_room();
  const SolveResult coarse = solve(scene, constant(150, 0));
  const SolveResult fine = solve(scene, constant(150, 2));
  EXPECT_EQ(fine.subdivision.patches, coarse.elements.count());
  ASSERT_EQ(fine.subdivision.elements.size(), 2u);
  EXPECT_GT(fine.subdivision.elements[0], 2 * fine.subdivision.patches);
  EXPECT_GT(fine.subdivision.elements[1], fine.subdivision.elements[0]);
  EXPECT_EQ(fine.subdivision.elements[1], fine.elements.count());
  EXPECT_LT(direct_error(scene, fine), 0.5 * direct_error(scene, coarse));
  // The room is closed and of one reflectance: ∫H = Φ / (1 − ρ).
  const double power = 24;
  double sum = 0;
  for (int e = 0; e < fine.elements.count(); ++e)
    sum += fine.elements.area[at(e)] * fine.solution.irradiance(e, 0);
  EXPECT_NEAR(sum, power / 0.5, 0.02 * power / 0.5);
}

TEST(Subdivision, EvenLightIsLeftAsItIs) {
  Scene furnace =
      test::room({1, 1, 1}, {{{.5, .5}, {.2, .8}, {.7, .3}, {.4, .6}, {.9, .1}, {.3, .7}}});
  const SolveResult result = solve(furnace, constant(100, 3));
  EXPECT_TRUE(result.subdivision.elements.empty());
  EXPECT_EQ(result.subdivision.patches, result.elements.count());
}

TEST(Subdivision, InterpolationBringsLightNearer) {
  const Scene scene = shaded_room();
  SolveOptions options = constant(2000, 0);
  options.radiosity.bounces = 0;
  const double constant_error = direct_error(scene, solve(scene, options));
  options.interpolate = true;
  const SolveResult result = solve(scene, options);
  EXPECT_TRUE(result.interpolated);
  EXPECT_EQ(result.irradiance.count(), result.elements.count());
  EXPECT_LT(direct_error(scene, result), 0.75 * constant_error);
}

TEST(Subdivision, IsRefusedWhereItTakesTooMany) {
  SolveOptions options = constant(150, 3);
  options.max_elements = 400;
  test::expect_error([&] { solve(shaded_room(), options); }, ErrorCode::too_large,
                     {"--max-elements", "--gradient"});
}

TEST(SteepElements, AreBothSidesOfAStep) {
  ElementTable e;
  e.corners.resize(4);
  e.neighbours = {{1, -1, -1}, {0, 2, -1}, {1, 3, -1}, {2, -1, -1}};
  ChannelArray values(4, 3);
  values << 1, 1, 1, 1.05, 1.05, 1.05, 2, 1, 1, 2, 1, 1;
  EXPECT_EQ(steep_elements(e, values, 0.2), (std::vector<int>{1, 2}));
  EXPECT_EQ(steep_elements(e, values, 0.04), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(steep_elements(e, values, 0.5).empty());
}

}  // namespace
}  // namespace halfshade
