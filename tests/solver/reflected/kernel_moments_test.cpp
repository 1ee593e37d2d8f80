#include "solver/reflected/kernel_moments.h"

#include "meshing/backprojection/edge_sum.h"
#include "solver/elements/quadrature.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

const std::array<Vec2, 3> cell = {Vec2(0.2, -0.4), Vec2(1.1, 0.1), Vec2(0.3, 0.9)};

/// A point with a normal that has the whole cell above its horizon.
PointAbovePlane random_point(test::Random& random, double height) {
  const double tilt = 0.2 * std::min(height, 1.);
  return {{random(-1, 2), random(-1, 2)},
          height,
          Vec3(random(-tilt, tilt), random(-tilt, tilt), -1).normalized()};
}

double form_factor(const PointAbovePlane& from, std::span<const Vec2> ring) {
  std::vector<Vec3> corners;
  for (const Vec2& q : ring) corners.emplace_back(q.x(), q.y(), 0);
  return unobstructed_factor({from.foot.x(), from.foot.y(), from.height}, from.normal,
                             std::array{corners});
}

TEST(KernelMoments, TheFirstIsTheFormFactorHoweverNear) {
  test::Random random(1);
  for (const double height : {3., 0.3, 0.01, 1e-4})
    for (int i = 0; i < 50; ++i) {
      const PointAbovePlane from = random_point(random, height);
      for (const double tolerance : {1e-5, 1e-8}) {
        KernelMoments moments(from, cell, 2, tolerance);
        moments.add(cell);
        EXPECT_NEAR(moments.values()[0], form_factor(from, cell), 30 * tolerance) << height;
      }
    }
}

TEST(KernelMoments, NeedlesTakeNoMoreThanOtherCells) {
  // Quarters of quarters of these are billions.
  test::Random random(3);
  for (const double width : {1e-3, 1e-6, 1e-9}) {
    const std::array<Vec2, 3> needle = {Vec2(-200, 0), Vec2(300, -width), Vec2(300, width)};
    for (int i = 0; i < 20; ++i) {
      const double height = width * random(0.1, 1);
      const PointAbovePlane from = {
          {random(-100, 200), width * random(-1, 1)}, height, -Vec3::UnitZ()};
      KernelMoments moments(from, needle, 2, 1e-9);
      moments.add(needle);
      // What corners are off by, hundreds of units away.
      const double rounding = 6e-14 / width;
      EXPECT_NEAR(moments.values()[0], form_factor(from, needle), 1e-6 + rounding) << width;
    }
  }
}

TEST(KernelMoments, AllAreThoseOfManySmallParts) {
  test::Random random(2);
  constexpr int parts = 60;
  const TriangleRule& rule = gauss_rule(8);
  for (int i = 0; i < 5; ++i) {
    const PointAbovePlane from = random_point(random, 0.2);
    std::array<double, most_moments> expected{};
    const auto add = [&](double s0, double t0, double size) {
      for (std::size_t k = 0; k < rule.places.size(); ++k) {
        const double s = s0 + size * rule.places[k].x(), t = t0 + size * rule.places[k].y();
        const Vec2 y = cell[0] + s * (cell[1] - cell[0]) + t * (cell[2] - cell[0]);
        const double area = 0.5 * ((cell[1] - cell[0]).x() * (cell[2] - cell[0]).y() -
                                   (cell[1] - cell[0]).y() * (cell[2] - cell[0]).x());
        const double w = rule.weights[static_cast<Eigen::Index>(k)] * area / (parts * parts) *
                         irradiance_kernel(from, y);
        const std::array<double, most_moments> powers = {
            1, s, t, s * s, s * t, t * t, s * s * s, s * s * t, s * t * t, t * t * t};
        for (std::size_t m = 0; m < powers.size(); ++m) expected[m] += w * powers[m];
      }
    };
    for (int a = 0; a < parts; ++a)
      for (int b = 0; a + b < parts; ++b) {
        add(a / 60., b / 60., 1 / 60.);
        if (a + b + 1 < parts) add((a + 1) / 60., (b + 1) / 60., -1 / 60.);
      }
    for (int order = 0; order <= 3; ++order) {
      KernelMoments moments(from, cell, order, 1e-9);
      moments.add(cell);
      ASSERT_EQ(moments.values().size(), at((order + 1) * (order + 2) / 2));
      for (std::size_t m = 0; m < moments.values().size(); ++m)
        EXPECT_NEAR(moments.values()[m], expected[m], 1e-7) << order << ' ' << m;
    }
  }
}

TEST(KernelMoments, WhatRunsClockwiseIsTakenAway) {
  test::Random random(3);
  const PointAbovePlane from = random_point(random, 0.5);
  const std::array<Vec2, 4> whole = {Vec2(0.3, 0), Vec2(0.7, 0.1), Vec2(0.6, 0.5), Vec2(0.3, 0.4)};
  const std::array<Vec2, 3> hole = {Vec2(0.4, 0.1), Vec2(0.4, 0.3), Vec2(0.5, 0.2)};
  const std::array<Vec2, 3> counter = {hole[0], hole[2], hole[1]};
  KernelMoments moments(from, cell, 1, 1e-9);
  moments.add(whole);
  moments.add(hole);
  EXPECT_NEAR(moments.values()[0], form_factor(from, whole) - form_factor(from, counter), 1e-8);
}

TEST(KernelMoments, OfACellWithoutAnyAreaAreNone) {
  test::Random random(4);
  const std::array<Vec2, 3> flat = {Vec2(0.3, 0.1), Vec2(0.3, 0.7), Vec2(0.3, 0.4)};
  KernelMoments moments(random_point(random, 0.5), flat, 2, 1e-9);
  moments.add(flat);
  for (const double value : moments.values()) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace halfshade
