#include "solver/pipeline/measured_error.h"

#include "solver/pipeline/solve.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A floor below twelve slats, narrower than elements are, and a small lamp.
Scene slats() {
  Scene scene;
  const int grey = test::add_material(scene, 0.5, 0), lamp = test::add_material(scene, 0, 1);
  const auto add = [&](double x0, double x1, double y, double z, int material, bool down) {
    std::vector<Vec3> corners = {{x0, -y, z}, {x1, -y, z}, {x1, y, z}, {x0, y, z}};
    if (down) std::reverse(corners.begin(), corners.end());
    test::add_polygon(scene, corners, material);
  };
  add(-2, 2, 2, 0, grey, false);
  for (int k = -6; k < 6; ++k) add(0.1 + 0.2 * k, 0.16 + 0.2 * k, 1.5, 0.6, grey, false);
  add(-0.05, 0.05, 0.05, 2, lamp, true);
  return scene;
}

/// Relative L2 error of constant elements, from exact direct light at places of its own.
double true_error(const PreparedScene& prepared, const SolveResult& result) {
  test::Random random(5);
  double off = 0, all = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto [a, b, c] = result.elements.triangle(e);
    for (int k = 0; k < 1000; ++k) {
      double u = random(0, 1), v = random(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const SurfacePoint point{a + u * (b - a) + v * (c - a), result.elements.normal[at(e)]};
      const double exact = prepared.direct_light().irradiance(point).irradiance[0];
      const double share = result.elements.area[at(e)] / 1000;
      off += share * std::pow(exact - result.solution.direct_irradiance(e, 0), 2);
      all += share * std::pow(result.solution.irradiance(e, 0), 2);
    }
  }
  return std::sqrt(off / all);
}

TEST(MeasuredError, KnowsShadowsThatElementsAreTooLargeFor) {
  const Scene scene = slats();
  const PreparedScene prepared(scene);
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.discontinuities = false;
  for (const int elements : {150, 1000}) {
    options.elements = elements;
    for (const DirectLightBy way : {DirectLightBy::exact, DirectLightBy::matrix}) {
      options.direct_light = way;
      const SolveResult result = solve(scene, options);
      const double error = true_error(prepared, result);
      EXPECT_GT(error, 0.1);
      EXPECT_GT(result.relative_error, 0.9 * error) << elements;
      EXPECT_LT(result.relative_error, 2 * error) << elements;
    }
  }
}

TEST(MeasuredError, IsRelativeToLightOfAnySize) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.discontinuities = false;
  options.elements = 150;
  Scene scene = slats();
  const double expected = solve(scene, options).relative_error;
  for (const double exitance : {1e-190, 1e190}) {
    scene.materials[1].exitance.setConstant(exitance);
    EXPECT_NEAR(solve(scene, options).relative_error, expected, 1e-9) << exitance;
  }
}

/// All light falls on a wall of two elements, along whose edge it comes from. The far ground makes
/// elements that large.
TEST(MeasuredError, KnowsWhatFewBrightElementsMissWhereTheMatrixMakesDirectLight) {
  Scene scene;
  const int black = test::add_material(scene, 0, 0), lamp = test::add_material(scene, 0, 1);
  test::add_polygon(scene, {{0, 0, 0}, {0, .1, 0}, {0, .1, .1}, {0, 0, .1}}, black);
  test::add_polygon(scene, {{0, 0, .1}, {0, .1, .1}, {.1, .1, .1}, {.1, 0, .1}}, lamp);
  test::add_polygon(scene, {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}}, black);
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.direct_light = DirectLightBy::matrix;
  options.elements = 1000;
  const PreparedScene prepared(scene);
  const SolveResult result = solve(scene, options);
  const double error = true_error(prepared, result);
  EXPECT_GT(error, 0.3);
  EXPECT_GT(result.relative_error, 0.9 * error);
}

}  // namespace
}  // namespace halfshade
