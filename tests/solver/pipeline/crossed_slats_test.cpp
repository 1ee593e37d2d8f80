#include "solver/pipeline/direct_rays.h"
#include "solver/pipeline/solve.h"
#include "tests/support/direct_error.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/turned_slats.h"

#include <gtest/gtest.h>

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
  const SolveOptions options = test::directly(0.02);
  EXPECT_EQ(direct_rays(prepared, options).deviation, 0);
  const SolveResult result = solve(prepared, options);
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  EXPECT_FALSE(result.refinement.is_noisy);
  EXPECT_LE(result.relative_error, 0.02);
  EXPECT_LE(test::direct_error(prepared, result), 0.02);
}

// Rays take about as long as exact looks there, and polynomials that are fitted to noise need many
// more of them.
TEST(TurnedSlats, AreLookedAtExactly) {
  const PreparedScene prepared(test::turned_slats(50));
  EXPECT_EQ(direct_rays(prepared, test::directly(0.01)).deviation, 0);
  EXPECT_EQ(direct_rays(prepared, test::directly(0.03)).deviation, 0);
}

TEST(TurnedSlats, AreSolvedToTheTolerance) {
  const PreparedScene prepared(test::turned_slats(50));
  const SolveResult result = solve(prepared, test::directly(0.025));
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  EXPECT_LE(result.relative_error, 0.025);
  EXPECT_LE(test::direct_error(prepared, result), 0.025);
}

}  // namespace
}  // namespace halfshade
