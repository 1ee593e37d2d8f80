#include "meshing/patches/curve_polylines.h"

#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

DiscontinuityCurve curve_of(int order, const std::array<double, 3>& jump) {
  DiscontinuityCurve curve;
  curve.order = order;
  curve.jump = jump;
  curve.arc = straight_arc({0, 0}, {1, 0});
  return curve;
}

// A quarter of the unit circle.
ConicArc quarter_circle() { return {{1, 0}, {1, 1}, {0, 1}, std::sqrt(0.5), false}; }

TEST(IsNegligible, ComparesTaylorTermsWithTheTolerance) {
  // The damage J h^k / k! for h = 0.1 and J = 3.
  for (const auto& [order, damage] : {std::pair(1, 0.3), std::pair(2, 0.015), std::pair(3, 5e-4)}) {
    EXPECT_TRUE(is_negligible(curve_of(order, {3, 0, 0}), 0.1, damage * 1.001));
    EXPECT_FALSE(is_negligible(curve_of(order, {3, 0, 0}), 0.1, damage * 0.999));
  }
}

TEST(IsNegligible, TheLargestOfTheThreeJumpsCountsWhateverItsSign) {
  for (const std::array<double, 3>& jump :
       {std::array<double, 3>{-3, 0, 1}, {0, -3, 0}, {1, 2, 3}, {-1, -2, -3}})
    EXPECT_FALSE(is_negligible(curve_of(2, jump), 0.1, 0.0149));
  EXPECT_FALSE(is_negligible(curve_of(2, {0, infinity, 0}), 0.1, 1e9));
}

TEST(IsNegligible, OrderZeroStays) {
  EXPECT_FALSE(is_negligible(curve_of(0, {0, 0, 0}), 0.1, 1e9));
}

TEST(IsNegligible, NothingIsWithoutATolerance) {
  EXPECT_FALSE(is_negligible(curve_of(1, {0, 0, 0}), 0.1, 0));
}

TEST(ElementSize, IsWhatIsAskedForButNotMoreThanTheSurface) {
  EXPECT_DOUBLE_EQ(element_size(4, 0), 0.2);
  EXPECT_DOUBLE_EQ(element_size(4, 0.7), 0.7);
  EXPECT_DOUBLE_EQ(element_size(4, 7), 4);
}

TEST(FlatteningDeviation, IsWhereTheDamageReachesTheTolerance) {
  // J2 = 0.15 and 1e-7: the deviation is sqrt(2e-7 / 0.15).
  EXPECT_NEAR(flattening_deviation(curve_of(2, {0.15, 0, 0}), 4, {.irradiance_tolerance = 1e-7}),
              1.1547e-3, 1e-7);
  EXPECT_NEAR(flattening_deviation(curve_of(1, {0, -2, 0}), 4, {.irradiance_tolerance = 1e-3}),
              5e-4, 1e-15);
}

TEST(FlatteningDeviation, StaysWithinLimits) {
  // A tenth of an element of a twentieth of the size, or of those asked for.
  EXPECT_DOUBLE_EQ(flattening_deviation(curve_of(2, {1e-9, 0, 0}), 4, {.irradiance_tolerance = 1}),
                   0.02);
  EXPECT_DOUBLE_EQ(flattening_deviation(curve_of(2, {0, 0, 0}), 4,
                                        {.max_length = 0.1, .irradiance_tolerance = 1}),
                   0.01);
  for (const double jump : {1e12, infinity})
    EXPECT_DOUBLE_EQ(
        flattening_deviation(curve_of(2, {jump, 0, 0}), 4, {.irradiance_tolerance = 1e-9}), 4e-5);
}

TEST(FlatteningDeviation, IsASmallPartOfTheSurfaceWithoutTolerance) {
  EXPECT_DOUBLE_EQ(flattening_deviation(curve_of(2, {1, 1, 1}), 4, {}), 4e-4);
  EXPECT_DOUBLE_EQ(flattening_deviation(curve_of(0, {1, 1, 1}), 4, {.irradiance_tolerance = 1}),
                   4e-4);
}

TEST(CurvePolylines, KeepEndsExactlyAndStayWithinTheirDeviation) {
  const SoundScene scene = test::s1();
  Discontinuities found;
  found.curves.push_back(curve_of(2, {1, 1, 1}));
  found.curves.push_back(curve_of(2, {1, 1, 1}));
  found.curves[0].receiver = found.curves[1].receiver = 2;
  found.curves[1].arc = quarter_circle();
  const CurvePolylines lines = curve_polylines(scene, found, {});
  EXPECT_EQ(lines.kept, 2u);
  EXPECT_EQ(lines.culled, 0u);
  ASSERT_EQ(lines.of_surface.size(), 3u);
  EXPECT_TRUE(lines.of_surface[0].empty());
  ASSERT_EQ(lines.of_surface[2].size(), 2u);
  EXPECT_EQ(lines.of_surface[2][0].points, std::vector<Vec2>({{0, 0}, {1, 0}}));
  EXPECT_EQ(lines.of_surface[2][0].id, 0);
  const CurvePolyline& round = lines.of_surface[2][1];
  EXPECT_EQ(round.id, 1);
  EXPECT_EQ(round.points.front(), Vec2(1, 0));
  EXPECT_EQ(round.points.back(), Vec2(0, 1));
  // A chord that spans an angle φ of the unit circle is off by 1 − cos(φ/2).
  const double allowed = 1e-4 * 3.7984 * std::sqrt(2.0);
  EXPECT_NEAR(lines.deviation[2], allowed, 1e-9);
  for (std::size_t i = 1; i < round.points.size(); ++i) {
    EXPECT_NEAR(round.points[i].norm(), 1, 1e-12);
    EXPECT_LE(1 - 0.5 * (round.points[i] + round.points[i - 1]).norm(), allowed);
  }
  EXPECT_LT(round.points.size(), 40u);
}

TEST(CurvePolylines, CulledCurvesAreCountedAndLeftOut) {
  const SoundScene scene = test::s1();
  Discontinuities found;
  for (const double jump : {1., 1e-3, 1e-6}) {
    found.curves.push_back(curve_of(1, {jump, 0, 0}));
    found.curves.back().receiver = 2;
  }
  // Elements of 0.1: damages 0.1, 1e-4 and 1e-7.
  const CurvePolylines lines =
      curve_polylines(scene, found, {.max_length = 0.1, .irradiance_tolerance = 1e-5});
  EXPECT_EQ(lines.kept, 2u);
  EXPECT_EQ(lines.culled, 1u);
  ASSERT_EQ(lines.of_surface[2].size(), 2u);
  EXPECT_EQ(lines.of_surface[2][1].id, 1);
  EXPECT_EQ(lines.deviation[2], 0);  // straight ones are not flattened
}

}  // namespace
}  // namespace halfshade
