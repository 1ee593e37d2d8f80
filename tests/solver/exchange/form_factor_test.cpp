#include "solver/exchange/form_factor.h"

#include "tests/support/analytic.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace halfshade {
namespace {

using Polygon = std::vector<Vec3>;

constexpr double relative = 1e-8;

void expect_close(double value, double expected, double tolerance = relative) {
  EXPECT_NEAR(value / expected, 1, tolerance) << value << " against " << expected;
}

/// The rectangle o, o+u, o+u+v, o+v.
Polygon rectangle(const Vec3& o, const Vec3& u, const Vec3& v) {
  return {o, o + u, o + u + v, o + v};
}

Polygon reversed(Polygon p) {
  std::reverse(p.begin(), p.end());
  return p;
}

/// Floor [0,l]×[0,w] and the wall over the edge y = 0 that leans over the floor at the angle phi.
Polygon floor_rectangle(double l, double w) { return rectangle({0, 0, 0}, {l, 0, 0}, {0, w, 0}); }
Polygon leaning_wall(double l, double h, double phi) {
  return rectangle({l, 0, 0}, {-l, 0, 0}, {0, h * std::cos(phi), h * std::sin(phi)});
}

TEST(PointToPolygon, ParallelRectangleOverItsCorner) {
  const Polygon ceiling = reversed(rectangle({0, 0, 1.5}, {1, 0, 0}, {0, 2, 0}));
  const double F = point_to_polygon(Vec3::Zero(), Vec3::UnitZ(), ceiling);
  expect_close(F, test::point_parallel_rectangle(1, 2, 1.5));
  EXPECT_NEAR(F, 0.1223596616423, 1e-12);
}

TEST(PointToPolygon, PerpendicularRectangleWithAndWithoutAPartBelowTheHorizon) {
  const double expected = test::point_perpendicular_rectangle(1.2, 0.8, 0.5);
  EXPECT_NEAR(expected, 0.12732745877429, 1e-13);
  const Polygon wall = {{0.5, 0, 0}, {0.5, 0, 1.2}, {0.5, 0.8, 1.2}, {0.5, 0.8, 0}};
  expect_close(point_to_polygon(Vec3::Zero(), Vec3::UnitZ(), wall), expected);
  const Polygon deeper = {{0.5, 0, -3}, {0.5, 0, 1.2}, {0.5, 0.8, 1.2}, {0.5, 0.8, -2}};
  expect_close(point_to_polygon(Vec3::Zero(), Vec3::UnitZ(), deeper), expected);
}

TEST(PointToPolygon, NothingIsSeenOfTheBackOrBelowTheHorizon) {
  const Polygon ceiling = reversed(rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_EQ(point_to_polygon(Vec3::Zero(), -Vec3::UnitZ(), ceiling), 0);
  EXPECT_EQ(point_to_polygon({0.5, 0.5, 2}, -Vec3::UnitZ(), ceiling), 0);
}

TEST(PointToPolygon, NonConvexPolygonIsTheSumOfItsParts) {
  const double h = 0.7;
  const Polygon corner = {{0, 0, h}, {0, 2, h}, {1, 2, h}, {1, 1, h}, {2, 1, h}, {2, 0, h}};
  const Polygon lower = reversed(rectangle({0, 0, h}, {2, 0, 0}, {0, 1, 0}));
  const Polygon upper = reversed(rectangle({0, 1, h}, {1, 0, 0}, {0, 1, 0}));
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(-0.6, 0.64, 0.48)}) {
    const Vec3 x(0.9, 1.1, 0);
    EXPECT_NEAR(point_to_polygon(x, n, corner),
                point_to_polygon(x, n, lower) + point_to_polygon(x, n, upper), 1e-15);
  }
}

TEST(FormFactor, DirectlyOpposedRectangles) {
  const auto compute = [](double a, double b, double c) {
    return form_factor(rectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0}),
                       reversed(rectangle({0, 0, c}, {a, 0, 0}, {0, b, 0})));
  };
  EXPECT_NEAR(compute(1, 1, 1), 0.199824895698, 1e-11);
  EXPECT_NEAR(compute(1, 2, 1.5), 0.175934928155, 1e-11);
  for (const double c : {0.01, 0.1, 10., 100.})
    expect_close(compute(1.3, 0.4, c), test::opposed_rectangles(1.3, 0.4, c), 2e-8);
}

TEST(FormFactor, FarApartFollowsTheExpansionInSizeOverDistance) {
  // Mean squared distance of two points of one rectangle across the axis: (a² + b²)/6.
  const double a = 1.3, b = 0.4, c = 5000;
  const double expected = a * b / (std::numbers::pi * c * c) * (1 - (a * a + b * b) / (3 * c * c));
  expect_close(form_factor(rectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0}),
                           reversed(rectangle({0, 0, c}, {a, 0, 0}, {0, b, 0}))),
               expected, 1e-11);
}

TEST(FormFactor, PerpendicularRectanglesThatShareAnEdge) {
  const auto compute = [](double l, double w, double h) {
    return form_factor(floor_rectangle(l, w), leaning_wall(l, h, std::numbers::pi / 2));
  };
  EXPECT_NEAR(compute(1, 1, 1), 0.200043776075, 1e-11);
  EXPECT_NEAR(compute(2, 1, 1.5), 0.274884972028, 1e-11);
  for (const double w : {0.01, 0.3, 4.})
    expect_close(compute(1, w, 0.8), test::perpendicular_rectangles(1, w, 0.8));
}

TEST(FormFactor, SharedEdgeTakesFewPoints) {
  const MutualArea result = mutual_area(
      floor_rectangle(1, 0.7), leaning_wall(1, 1.3, std::numbers::pi / 2), {.tolerance = 1e-8});
  expect_close(result.value / 0.7, 0.262144276990);
  EXPECT_LE(result.points, 256);
  EXPECT_GE(result.error, 0.1 * std::abs(result.value - 0.7 * 0.262144276990));
}

TEST(FormFactor, InclinedRectanglesThatShareAnEdge) {
  const auto compute = [](double a, double b, double c, double degrees) {
    return form_factor(floor_rectangle(c, b), leaning_wall(c, a, degrees * std::numbers::pi / 180));
  };
  EXPECT_NEAR(compute(1, 1, 1, 60), 0.370905321150, 1e-11);
  EXPECT_NEAR(compute(1, 1, 1, 45), 0.483347695479, 1e-11);
  EXPECT_NEAR(compute(1, 1, 1, 120), 0.086615001118, 1e-11);
  EXPECT_NEAR(compute(1.5, 0.7, 2, 60), 0.555373455380, 1e-11);
  for (const double degrees : {10., 170.})
    expect_close(compute(1.5, 0.7, 2, degrees),
                 test::inclined_rectangles(1.5, 0.7, 2, degrees * std::numbers::pi / 180));
}

TEST(FormFactor, OffsetRectangles) {
  const Polygon floor = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1.5, 0});
  const Polygon above = reversed(rectangle({0.3, -0.5, 0.8}, {1.7, 0, 0}, {0, 1.2, 0}));
  EXPECT_NEAR(form_factor(floor, above), 0.217610338591, 1e-11);
  expect_close(form_factor(floor, above),
               test::offset_parallel_rectangles({0, 1}, {0, 1.5}, {0.3, 2}, {-0.5, 0.7}, 0.8));

  const Polygon strip = rectangle({0.4, 0, 0}, {0.8, 0, 0}, {0, 1.5, 0});
  const Polygon wall = {{0, -0.5, 0.3}, {0, 0.7, 0.3}, {0, 0.7, 0.9}, {0, -0.5, 0.9}};
  EXPECT_NEAR(form_factor(strip, wall), 0.055511264557, 1e-11);
  expect_close(form_factor(strip, wall), test::offset_perpendicular_rectangles(
                                             {0.4, 1.2}, {0, 1.5}, {0.3, 0.9}, {-0.5, 0.7}));
}

TEST(FormFactor, PartlySharedEdgesAndSharedVertices) {
  // The wall covers part of the floor's edge, reaches beyond it, or touches it in a corner only.
  const Polygon floor = rectangle({0, 0, 0}, {1.2, 0, 0}, {0, 1, 0});
  const auto wall = [](double y0, double y1) {
    return Polygon{{0, y0, 0}, {0, y1, 0}, {0, y1, 0.7}, {0, y0, 0.7}};
  };
  for (const auto& [y0, y1] : {std::pair{0.25, 0.6}, {0.5, 1.7}, {-0.4, 1.3}, {1., 2.}, {0., 1.}})
    expect_close(form_factor(floor, wall(y0, y1)),
                 test::offset_perpendicular_rectangles({0, 1.2}, {0, 1}, {0, 0.7}, {y0, y1}));
}

TEST(FormFactor, NearlyTouchingRectanglesConverge) {
  const Polygon floor = rectangle({0, 0, 0}, {1.2, 0, 0}, {0, 1, 0});
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    const Polygon wall = {{0, 0.2, gap}, {0, 1.3, gap}, {0, 1.3, 0.7}, {0, 0.2, 0.7}};
    expect_close(form_factor(floor, wall),
                 test::offset_perpendicular_rectangles({0, 1.2}, {0, 1}, {gap, 0.7}, {0.2, 1.3}));
  }
}

TEST(FormFactor, PlanesThatCutEachOtherAreClipped) {
  // Both reach through the other's plane; only the quadrant where they face each other counts.
  const Polygon floor = rectangle({-2, 0, 0}, {3.2, 0, 0}, {0, 1.5, 0});
  const Polygon wall = {{0, -0.5, -1}, {0, 0.7, -1}, {0, 0.7, 0.9}, {0, -0.5, 0.9}};
  const double expected =
      1.2 * 1.5 * test::offset_perpendicular_rectangles({0, 1.2}, {0, 1.5}, {0, 0.9}, {-0.5, 0.7});
  expect_close(mutual_area(floor, wall).value, expected);
  expect_close(mutual_area(wall, floor).value, expected);
  EXPECT_EQ(mutual_area(floor, reversed(rectangle({3, 0, 0}, {1, 0, 0}, {0, 1, 0}))).value, 0);
}

TEST(FormFactor, ReciprocalForTriangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&](double z) { return Vec3(u(random), u(random), z + 0.3 * u(random)); };
  int compared = 0;
  for (int k = 0; k < 200; ++k) {
    const Polygon p = {point(0), point(0), point(0)}, q = {point(1), point(1), point(1)};
    const double pq = mutual_area(p, q).value, qp = mutual_area(q, p).value;
    EXPECT_NEAR(pq, qp, 1e-8 * std::max(pq, qp) + 1e-15);
    compared += pq > 1e-4;
  }
  EXPECT_GE(compared, 20);
}

TEST(FormFactor, TouchingTrianglesStayRightWhenRoundingMovesThemApart) {
  // The floor and wall triangles of a cube's edge, turned and shifted so that their common corners
  // lie a rounding error in front of or behind the other's plane.
  const Polygon floor = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, wall = {{1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
  const double expected = mutual_area(floor, wall).value;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 500; ++k) {
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Matrix3d R = Eigen::AngleAxisd(normal(random), axis).toRotationMatrix();
    const Vec3 shift = (k % 2 ? 1. : 1e5) * Vec3(normal(random), normal(random), normal(random));
    Polygon p = floor, q = wall;
    for (Vec3& v : p) v = R * v + shift;
    for (Vec3& v : q) v = R * v + shift;
    ASSERT_NEAR(mutual_area(p, q).value, expected, 1e-8) << "turn " << k;
    ASSERT_NEAR(mutual_area(q, p).value, expected, 1e-8) << "turn " << k;
  }
}

// Of needles rounding may put corners before the plane of what coincides with them, whether that
// looks the same way or not.
/// What rounding leaves of each other before the planes of two rectangles in one plane: no
/// tolerance relative to nothing is reached, so that all points were taken.
TEST(FormFactor, WhatIsInOnePlaneTakesFewPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  FormFactorOptions options;
  options.tolerance = 1e-5;
  options.max_points = 100000;
  for (int k = 0; k < 200; ++k) {
    const Vec3 normal = any().normalized(), u = any().cross(normal), v = normal.cross(any());
    const Vec3 o = any(), away = 3 * u + 2 * v;
    const MutualArea area = mutual_area(rectangle(o, u, v), rectangle(o + away, v, u), options);
    EXPECT_LT(area.points, 20000) << k;
    EXPECT_LT(area.value, 1e-14) << k;
  }
}

TEST(FormFactor, NeedlesThatCoincideExchangeNothing) {
  const Polygon needle = {{0x1.7d3b9567caa47p+0, 0x1.7cea3d97b7774p+0, 0x1.194699d3dd8c2p-3},
                          {0x1.7e151b8ab10e8p+0, 0x1.7d619e08edaf5p+0, 0x1.1946ec9202a28p-3},
                          {0x1.7d3b9a913abefp+0, 0x1.7cea3bd20b4b5p+0, 0x1.19468df3287aap-3}};
  const Polygon same = {needle[2], needle[0], needle[1]};
  for (const Polygon& other : {same, reversed(same)})
    EXPECT_NEAR(form_factor(needle, other), 0, 1e-6);
}

TEST(FormFactor, CubeFacesAddUpToOneAndScaleAndRotationDoNotMatter) {
  for (const double size : {1e-6, 1., 1e6}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const auto move = [&](Polygon p) {
      for (Vec3& v : p) v = R * (size * v);
      return p;
    };
    const Polygon floor = move(floor_rectangle(1, 1));
    const double beside = form_factor(floor, move(leaning_wall(1, 1, std::numbers::pi / 2)));
    const double above =
        form_factor(floor, move(reversed(rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}))));
    EXPECT_NEAR(4 * beside + above, 1, 1e-9) << "size " << size;
  }
}

}  // namespace
}  // namespace halfshade
