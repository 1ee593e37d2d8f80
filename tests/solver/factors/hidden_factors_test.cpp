#include "solver/factors/factor_matrix.h"
#include "solver/factors/mutual_sight.h"
#include "tests/support/analytic.h"
#include "tests/support/face_factors.h"
#include "tests/support/scenes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

struct Span {
  double low, high;
};

/// A sheet parallel to the unit squares in z = 0 and z = 1, at height h.
struct HidingSheet {
  Span x, y;
  double h;
};

/// What a point of the lower square sees of the upper one through everything but the sheet, in one
/// coordinate: [0, 1] and the sheet's shadow in it, relative to the point.
Span shadow(double at, Span sheet, double h) {
  const auto clip = [&](double v) { return std::clamp(at + (v - at) / h, 0., 1.); };
  return {clip(sheet.low) - at, clip(sheet.high) - at};
}

/// Where that is not smooth: the shadow's limits pass those of the square.
std::vector<double> breaks(Span sheet, double h) {
  std::vector<double> result = {0, 1};
  for (const double v : {sheet.low, sheet.high})
    for (const double limit : {0., 1.})
      if (const double at = (v - limit * h) / (1 - h); at > 0 && at < 1) result.push_back(at);
  std::sort(result.begin(), result.end());
  return result;
}

/// ∫ f over the pieces, by Gauss's rule with five points in parts of each.
template <class F>
double integrate(const std::vector<double>& breaks, F f) {
  constexpr double x[] = {0, 0.5384693101056831, 0.9061798459386640};
  constexpr double w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  constexpr int parts = 16;
  double sum = 0;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double half = 0.5 * (breaks[k + 1] - breaks[k]) / parts;
    for (int p = 0; p < parts; ++p) {
      const double middle = breaks[k] + (2 * p + 1) * half;
      sum += half * w[0] * f(middle);
      for (int i = 1; i < 3; ++i)
        sum += half * w[i] * (f(middle - half * x[i]) + f(middle + half * x[i]));
    }
  }
  return sum;
}

/// Form factor between the squares: a closed form at points, integrated between its kinks.
double expected_factor(const HidingSheet& sheet) {
  const double hidden = integrate(breaks(sheet.x, sheet.h), [&](double x) {
    const Span in_x = shadow(x, sheet.x, sheet.h);
    return integrate(breaks(sheet.y, sheet.h), [&](double y) {
      const Span in_y = shadow(y, sheet.y, sheet.h);
      return test::point_parallel_rectangle(in_x.low, in_x.high, in_y.low, in_y.high, 1);
    });
  });
  return test::opposed_rectangles(1, 1, 1) - hidden;
}

Scene scene_of(const HidingSheet& sheet) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, material);
  test::add_polygon(scene, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, material);
  const auto [x, y, h] = sheet;
  test::add_polygon(
      scene, {{x.low, y.low, h}, {x.high, y.low, h}, {x.high, y.high, h}, {x.low, y.high, h}},
      material);
  return scene;
}

const std::vector<HidingSheet> sheets = {
    {{.25, .75}, {.25, .75}, .5},  {{.1, .4}, {.3, .95}, .3},   {{.4, .6}, {.45, .55}, .7},
    {{.49, .51}, {.49, .51}, .5},  {{-.3, .5}, {.2, 1.4}, .4},  {{.2, .7}, {.3, .6}, .05},
    {{.31, .62}, {.17, .48}, .01}, {{.05, .95}, {.05, .95}, .9}};

/// Factor between the squares and its error.
MutualSight see(const HidingSheet& sheet, double tolerance) {
  const FactorScene sound = make_factor_scene(scene_of(sheet), FactorUnit::face);
  const SightScene sight = make_sight_scene(sound.sound);
  return partial_sight(sight, 0, 1, {tolerance, tolerance, 300000});
}

TEST(HiddenFactors, SquaresWithASheetBetweenThem) {
  for (const HidingSheet& sheet : sheets) {
    const MutualSight seen = see(sheet, 1e-7);
    EXPECT_NEAR(seen.value, expected_factor(sheet), 1e-7) << sheet.h;
    EXPECT_TRUE(seen.is_reached) << sheet.h;
  }
}

TEST(HiddenFactors, TheErrorIsABound) {
  for (const HidingSheet& sheet : sheets) {
    const double expected = expected_factor(sheet);
    for (const double tolerance : {3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6}) {
      const MutualSight seen = see(sheet, tolerance);
      EXPECT_LE(std::abs(seen.value - expected), seen.error) << sheet.h << " " << tolerance;
      EXPECT_LE(seen.error, 1.01 * tolerance);
    }
  }
}

/// Files hold coordinates as doubles, as floats, or with six digits.
enum class Digits { all, of_float, six };

double rounded(double x, Digits digits) {
  if (digits == Digits::all) return x;
  if (digits == Digits::of_float) return static_cast<float>(x);
  const double unit = std::pow(10., std::floor(std::log10(std::max(std::abs(x), 1e-4))) - 5);
  return std::round(x / unit) * unit;
}

/// Turned as a whole, nothing lies in a coordinate plane, nor exactly where it should; a sheet with
/// two rows hides as much.
TEST(HiddenFactors, SquaresTurnedInSpace) {
  const HidingSheet sheet{{.2, .7}, {.3, .6}, .4};
  const double expected = expected_factor(sheet);
  struct Case {
    Digits digits;
    double tolerance, moved;
  };
  for (const auto& [digits, tolerance, moved] :
       {Case{Digits::all, 1e-5, 0}, Case{Digits::all, 1e-8, 0}, Case{Digits::of_float, 1e-5, 6e-8},
        Case{Digits::six, 1e-5, 5e-6}})
    for (const double angle : {0.4, 1.3, 2.9})
      for (const bool is_two_sided : {false, true}) {
        Scene scene = scene_of(sheet);
        const Eigen::AngleAxisd turn(angle, Vec3(1, 2, -3).normalized());
        for (Vec3& p : scene.vertices) {
          p = turn * p;
          for (double& x : p) x = rounded(x, digits);
        }
        scene.faces[2].material = test::add_material(scene, 0.5, 0);
        scene.materials[1].two_sided = is_two_sided;
        const FactorMatrix matrix = test::face_factors(scene, tolerance);
        ASSERT_EQ(matrix.area.size(), is_two_sided ? 4 : 3);
        EXPECT_NEAR(matrix.factors(0, 1), expected, matrix.error[0] + 4 * moved) << angle;
        EXPECT_LE(matrix.error.maxCoeff(), tolerance) << angle;
        EXPECT_LE((matrix.row_sum - 1).abs().maxCoeff(), 2 * tolerance) << angle;
        EXPECT_EQ(matrix.report.rows_not_reached, 0) << angle;
      }
}

TEST(HiddenFactors, RowsSumToOne) {
  for (const HidingSheet& sheet : sheets)
    EXPECT_LT((test::face_factors(scene_of(sheet), 1e-4).row_sum - 1).abs().maxCoeff(), 2e-4)
        << sheet.h;
}

TEST(HiddenFactors, TinyThingsAreNotOverlooked) {
  // What six of 0.01 × 0.01 hide of each other is next to nothing.
  Scene scene = scene_of({{.2, .21}, {.7, .71}, .01});
  double expected =
      test::opposed_rectangles(1, 1, 1) - expected_factor({{.2, .21}, {.7, .71}, .01});
  for (int k = 1; k < 6; ++k) {
    const HidingSheet sheet{{.12 * k, .12 * k + .01}, {.6 - .06 * k, .61 - .06 * k}, .03 + .13 * k};
    const int first = static_cast<int>(scene.vertices.size());
    const Scene other = scene_of(sheet);
    Face face = other.faces[2];
    for (int& v : face.vertices) v += first - 8;
    scene.vertices.insert(scene.vertices.end(), other.vertices.begin() + 8, other.vertices.end());
    scene.faces.push_back(face);
    expected += test::opposed_rectangles(1, 1, 1) - expected_factor(sheet);
  }
  const FactorMatrix matrix = test::face_factors(scene, 1e-4);
  const double hidden = test::opposed_rectangles(1, 1, 1) - matrix.factors(0, 1);
  EXPECT_NEAR(hidden, expected, 0.02 * expected + matrix.error[0]);
  EXPECT_GT(hidden, 0);
}

/// So close to one of them rows of few points are off by more than all entries claim.
TEST(HiddenFactors, ASheetCloseToASquare) {
  const HidingSheet sheet{{.0309, .5167}, {.2789, 1.1066}, .02};
  const FactorMatrix matrix = test::face_factors(scene_of(sheet), 1e-6);
  EXPECT_NEAR(matrix.factors(0, 1), expected_factor(sheet), matrix.error[0]);
  EXPECT_LE(matrix.error.maxCoeff(), 1e-6);
  EXPECT_LE((matrix.row_sum - 1).abs().maxCoeff(), 2e-6);
  EXPECT_EQ(matrix.report.rows_not_reached, 0);
}

/// Nothing is asked of the machine any more once a run was stopped, whatever a pair would take.
TEST(HiddenFactors, StoppedPairsEndAtOnce) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1.1, 1, 0}, {0, 1, 0}}, material);
  test::add_polygon(scene, {{0, 0, 1e-6}, {0, 1, 1e-6}, {1, 1.1, 1e-6}, {1, 0, 1e-6}}, material);
  const FactorScene sound = make_factor_scene(scene, FactorUnit::face);
  const SightScene sight = make_sight_scene(sound.sound);
  std::stop_source source;
  source.request_stop();
  const auto before = std::chrono::steady_clock::now();
  const SightTolerance unreachable{1e-300, 0, 100000000};
  EXPECT_FALSE(clear_sight(sight, 0, 1, unreachable, source.get_token()).is_reached);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(1));
}

}  // namespace
}  // namespace halfshade
