#include "solver/factors/factor_scene.h"
#include "solver/factors/mutual_sight.h"
#include "tests/support/analytic.h"
#include "tests/support/face_factors.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace halfshade {
namespace {

using Side = std::array<double, 2>;

/// The first looks up from z = 0, the second down at it from the gap.
Scene two_plates(Side x, Side y, Side xi, Side eta, double gap) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{x[0], y[0], 0}, {x[1], y[0], 0}, {x[1], y[1], 0}, {x[0], y[1], 0}},
                    material);
  test::add_polygon(
      scene,
      {{xi[0], eta[0], gap}, {xi[0], eta[1], gap}, {xi[1], eta[1], gap}, {xi[1], eta[0], gap}},
      material);
  return scene;
}

/// Unit squares that share the edge y = 0.
Scene wedge(double angle) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  const Vec3 x(1, 0, 0), up(0, std::cos(angle), std::sin(angle)), y(0, 1, 0);
  test::add_polygon(scene, {{0, 0, 0}, x, x + y, y}, material);
  test::add_polygon(scene, {{0, 0, 0}, up, x + up, x}, material);
  return scene;
}

/// C-11 of unit squares, in a form that does not cancel where they are close, else by moments of
/// what their points are apart.
double opposed_squares(double gap) {
  constexpr double pi = std::numbers::pi;
  const double g2 = gap * gap, root = std::sqrt(1 + g2);
  if (gap > 50) return (1 - 2 / (3 * g2) + 17 / (30 * g2 * g2)) / (pi * g2);
  if (gap > 1) return test::opposed_rectangles(1, 1, gap);
  const double logs = -2 * std::log(gap) - std::log(2.) + 2 * std::log1p(g2) - std::log1p(g2 / 2);
  return 2 / pi *
         (g2 * logs / 2 + 2 * root * std::atan(1 / root) - gap * (pi - 2 * std::atan(gap)));
}

/// C-13, and where it cancels Gauss's rule with five points in each of the four directions.
double offset_plates(Side x, Side y, Side xi, Side eta, double gap) {
  if (gap < 5) return test::offset_parallel_rectangles(x, y, xi, eta, gap);
  constexpr std::array at = {-0.9061798459386640, -0.5384693101056831, 0., 0.5384693101056831,
                             0.9061798459386640};
  constexpr std::array weight = {0.1184634425280945, 0.2393143352496832, 0.2844444444444444,
                                 0.2393143352496832, 0.1184634425280945};
  const auto place = [&](Side s, std::size_t k) {
    return (s[0] + s[1]) / 2 + at[k] * (s[1] - s[0]) / 2;
  };
  double sum = 0;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t l = 0; l < 5; ++l) {
          const double u = (place(x, i) - place(xi, k)) / gap;
          const double v = (place(y, j) - place(eta, l)) / gap;
          sum += weight[i] * weight[j] * weight[k] * weight[l] / std::pow(1 + u * u + v * v, 2);
        }
  return sum * (xi[1] - xi[0]) * (eta[1] - eta[0]) / (std::numbers::pi * gap * gap);
}

/// The first row: its factor to the other face, and what is left for space, which is found on its
/// own.
void expect_row(const FactorMatrix& matrix, double expected, double tolerance,
                const std::string& what) {
  constexpr double rounding = 1e-13, of_closed_form = 2e-10;
  EXPECT_EQ(matrix.report.rows_not_reached, 0) << what;
  EXPECT_LE(matrix.error[0], tolerance) << what;
  EXPECT_NEAR(matrix.factors(0, 1), expected, 1e-8 * expected) << what;
  EXPECT_NEAR(matrix.factors(0, 1), expected, matrix.error[0] + of_closed_form * expected) << what;
  EXPECT_NEAR(matrix.space[0], 1 - expected, matrix.error[0] + of_closed_form * expected + rounding)
      << what;
}

std::string said(double number, double tolerance) {
  return "at " + std::to_string(std::log10(number)) + ", " + std::to_string(std::log10(tolerance));
}

/// What leaves a gap does so from a rim as wide as the gap.
TEST(NarrowGaps, BetweenSquares) {
  for (int power = -6; power <= 6; ++power)
    for (const double tolerance : {1e-8, 1e-9}) {
      const double gap = std::pow(10., power);
      const FactorMatrix matrix =
          test::face_factors(two_plates({0, 1}, {0, 1}, {0, 1}, {0, 1}, gap), tolerance);
      expect_row(matrix, opposed_squares(gap), tolerance, said(gap, tolerance));
    }
}

TEST(NarrowGaps, BetweenPlatesOfOtherSizes) {
  const Side x = {0, 1}, y = {0, 1.5}, xi = {.3, .8}, eta = {-.2, .5};
  for (int power = -6; power <= 6; ++power)
    for (const double tolerance : {1e-8, 1e-9}) {
      const double gap = std::pow(10., power);
      const FactorMatrix matrix = test::face_factors(two_plates(x, y, xi, eta, gap), tolerance);
      expect_row(matrix, offset_plates(x, y, xi, eta, gap), tolerance, said(gap, tolerance));
    }
}

TEST(NarrowGaps, BetweenSquaresThatShareAnEdge) {
  for (const double angle : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1})
    for (const double tolerance : {1e-8, 1e-9}) {
      const FactorMatrix matrix = test::face_factors(wedge(angle), tolerance);
      expect_row(matrix, test::inclined_rectangles(1, 1, 1, angle), tolerance,
                 said(angle, tolerance));
    }
}

/// From nowhere but a rim of the lower square the ceiling is seen, so narrow that no point of the
/// first cells, nor what was looked at near their corners, finds it: the error tells. What is seen
/// grows like the gap.
TEST(NarrowGaps, WhatIsSeenFromARimAloneIsNotOverlooked) {
  const auto seen = [](double gap, double tolerance) {
    const FactorScene sound =
        make_factor_scene(two_plates({0, 1}, {0, 1}, {0, 1}, {0, 1}, gap), FactorUnit::face);
    const SightScene sight = make_sight_scene(sound.sound);
    int ceiling = 0;
    while (sight.surfaces[at(ceiling)].frame.normal.z() > -0.5 || sound.row[at(ceiling)] >= 0)
      ++ceiling;
    return partial_sight(sight, 0, ceiling, {tolerance, tolerance, 300000});
  };
  const MutualSight wide = seen(1e-3, 1e-9);
  EXPECT_GT(wide.value, 5e-4);
  for (const double gap : {1e-4, 1e-5, 1e-6}) {
    const MutualSight narrow = seen(gap, 1e-9);
    EXPECT_NEAR(narrow.value / gap, wide.value / 1e-3, 3e-3 * wide.value / 1e-3) << gap;
    EXPECT_LE(narrow.error, 1e-9) << gap;
  }
}

}  // namespace
}  // namespace halfshade
