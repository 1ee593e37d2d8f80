#include "solver/factors/factor_matrix.h"
#include "tests/support/analytic.h"
#include "tests/support/face_factors.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A square that looks down at the back of a slab's underside, below which a post stands: of the
/// post it sees the top, and all else that it sees are backs.
TEST(UnusedBacks, AreThereBesideWhatStandsOnTheFace) {
  test::SceneMaker maker;
  maker.turned_box({-1, -1, 0}, {1, 1, .2}, 0).turned_box({-.1, -.1, -1}, {.1, .1, 0}, 0);
  maker.down({-.1, -.1}, {.1, .1}, .1);
  const FactorMatrix matrix = test::face_factors(maker.scene, 1e-6);
  const Eigen::Index square = matrix.row_sum.size() - 1;
  const double top = test::opposed_rectangles(.2, .2, .1);
  EXPECT_NEAR(matrix.factors.row(square).sum(), top, 1e-6);
  EXPECT_NEAR(matrix.backs[square], 1 - top, 1e-6);
  EXPECT_NEAR(matrix.row_sum[square], 1, 1e-6);
}

/// Of each sheet the other's face lies on a part of the back.
TEST(UnusedBacks, OfSheetsThatOverlapBackToBack) {
  test::SceneMaker maker;
  maker.up({0, 0}, {1, 1}, 0).down({.5, 0}, {1.5, 1}, 0).up({.1, .1}, {.4, .4}, -.2);
  const FactorMatrix matrix = test::face_factors(maker.scene, 1e-6);
  EXPECT_NEAR(matrix.factors(2, 1),
              test::offset_parallel_rectangles({.1, .4}, {.1, .4}, {.5, 1.5}, {0, 1}, .2), 1e-6);
  EXPECT_NEAR(matrix.backs[2],
              test::offset_parallel_rectangles({.1, .4}, {.1, .4}, {0, .5}, {0, 1}, .2), 1e-6);
}

}  // namespace
}  // namespace halfshade
