#include "solver/direct/direct_light.h"
#include "solver/pipeline/direct_rays.h"
#include "solver/pipeline/solve.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// Two layers of slats, one across the other, between a light and a floor: nearly all light that
/// varies is on the slats, and looking at the light takes long on the floor only.
Scene crossed_slats(int count) {
  test::SceneMaker maker;
  maker.down({-1, -1}, {1, 1}, 4, test::white_light);
  maker.up({-3, -3}, {3, 3}, 0);
  const double pitch = 4. / count;
  for (int i = 0; i < count; ++i) {
    const double from = -2 + pitch * i, to = from + pitch / 2;
    maker.up({from, -2}, {to, 2}, 2);
    maker.up({-2, from}, {2, to}, 2.2);
  }
  return maker.scene;
}

TEST(CrossedSlats, AreSolvedToTheToleranceWithoutCurvesAndRays) {
  const PreparedScene prepared(crossed_slats(50));
  SolveOptions options;
  options.tolerance = 0.02;
  options.radiosity.bounces = 0;
  EXPECT_EQ(direct_rays(prepared, options).deviation, 0);
  const SolveResult result = solve(prepared, options);
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  EXPECT_FALSE(result.refinement.is_noisy);
  EXPECT_LE(result.relative_error, 0.02);
  test::Random random(5);
  double square_error = 0, square = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    double s = random(0, 1), t = random(0, 1);
    if (s + t > 1) s = 1 - s, t = 1 - t;
    const Vec3 p = position(result.elements.triangle(e), {s, t});
    const Rgb exact =
        prepared.direct_light().irradiance({p, result.elements.normal[at(e)]}).irradiance;
    const double area = result.elements.area[at(e)];
    square += area * exact.matrix().squaredNorm();
    square_error += area * (value_at(result.irradiance, e, {s, t}) - exact).matrix().squaredNorm();
  }
  EXPECT_LE(std::sqrt(square_error / square), 0.02);
}

}  // namespace
}  // namespace halfshade
