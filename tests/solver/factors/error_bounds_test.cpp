#include "solver/factors/factor_matrix.h"
#include "tests/support/analytic.h"
#include "tests/support/face_factors.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// A rectangle in a plane z = height.
struct Sheet {
  double left, right, front, back, height;
  bool looks_up;
};

Scene scene_of(std::initializer_list<Sheet> sheets) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  for (const auto& [left, right, front, back, z, looks_up] : sheets) {
    std::vector<Vec3> corners = {
        {left, front, z}, {right, front, z}, {right, back, z}, {left, back, z}};
    if (!looks_up) std::reverse(corners.begin(), corners.end());
    test::add_polygon(scene, corners, material);
  }
  return scene;
}

void add_box(Scene& scene, const Vec3& low, const Vec3& high, bool inwards) {
  for (const auto& face : test::box_faces(low, high, inwards)) test::add_polygon(scene, face, 0);
}

/// The error is what an entry is off by, not what quadrature might be off by: closed forms tell the
/// factor, and the sum of the row tells what is left for space.
TEST(ErrorBounds, AreSharpForTwoPlates) {
  for (const double gap : {0.3, 1., 2.5})
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6}) {
      const FactorMatrix matrix = test::face_factors(
          scene_of({{0, 1, 0, 1, 0, true}, {0, 1, 0, 1, gap, false}}), tolerance);
      const double expected = test::opposed_rectangles(1, 1, gap);
      for (Eigen::Index row = 0; row < 2; ++row) {
        const double off = std::max(std::abs(matrix.factors(row, 1 - row) - expected),
                                    std::abs(matrix.space[row] - (1 - expected)));
        EXPECT_GE(matrix.error[row], off) << gap << " " << tolerance;
        EXPECT_LE(matrix.error[row], 10 * off + 1e-12) << gap << " " << tolerance;
      }
    }
}

/// A shield in the middle of a narrow gap: what is seen past it, by Gauss's rule between the kinks
/// of what points see, graded towards them.
TEST(ErrorBounds, ThinShieldsBetweenPlates) {
  struct Case {
    double gap, expected;
  };
  for (const auto& [gap, expected] : {Case{1e-2, 0.340695213056}, Case{1e-3, 0.358008420390},
                                      Case{1e-4, 0.359800098863}, Case{1e-5, 0.359980001135}})
    for (const double tolerance : {1e-2, 1e-3}) {
      const FactorMatrix matrix = test::face_factors(
          scene_of(
              {{0, 1, 0, 1, 0, true}, {0, 1, 0, 1, gap, false}, {.1, .9, .1, .9, gap / 2, true}}),
          tolerance);
      EXPECT_NEAR(matrix.factors(0, 1), expected, matrix.error[0]) << gap << " " << tolerance;
      EXPECT_EQ(matrix.report.rows_not_reached, 0) << gap << " " << tolerance;
    }
}

/// The back of a box that stands on the floor sees the floor below it, and nothing beyond its
/// sides, though they hide nothing as a silhouette.
TEST(ErrorBounds, BoxesThatStandHideTheRoomFromTheirInside) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  add_box(scene, {0, 0, 0}, {3, 3.1, 2.9}, true);
  add_box(scene, {.2, 1.18, 0}, {.86, 1.72, .53}, false);
  add_box(scene, {1.1, 1.11, .42}, {1.61, 1.74, .88}, false);
  for (const double tolerance : {1e-2, 1e-3}) {
    const FactorMatrix matrix = test::face_factors(scene, tolerance);
    EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), tolerance);
    EXPECT_EQ(matrix.report.rows_not_reached, 0) << tolerance;
    // The floor's backs are those of the box that stands, seen from below it.
    EXPECT_NEAR(matrix.backs[4], .66 * .54 / (3 * 3.1), tolerance);
  }
}

}  // namespace
}  // namespace halfshade
