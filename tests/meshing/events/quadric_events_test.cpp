#include "meshing/events/quadric_events.h"

#include "tests/support/critical_conic.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

using test::Conic;
using test::critical_conic;
using test::Random;
using Vec3l = Eigen::Matrix<long double, 3, 1>;

Line3 random_line(Random& random) {
  return {random.in_box({-1, -1, -1}, {1, 1, 1}), random(0.3, 3) * random.direction()};
}

std::array<Line3, 3> random_lines(Random& random) {
  return {random_line(random), random_line(random), random_line(random)};
}

PlaneFrame random_plane(Random& random) {
  return make_frame(random.in_box({-1, -1, -3}, {1, 1, -2}),
                    Vec3::UnitZ() + 0.5 * random.direction());
}

Vec3l point_l(const LineFamily& family, double t) {
  return family.lines[0].point.cast<long double>() +
         t * family.lines[0].direction.cast<long double>();
}

Vec3l normal_l(const Line3& line, const Vec3l& x) {
  return (line.point.cast<long double>() - x).cross(line.direction.cast<long double>());
}

/// det[n₂, n₃, n_f](t) in extended precision, from its definition.
long double determinant(const LineFamily& family, const Line3& f, double t) {
  const Vec3l x = point_l(family, t);
  return normal_l(family.lines[1], x).dot(normal_l(family.lines[2], x).cross(normal_l(f, x)));
}

Vec3l direction_l(const LineFamily& family, double t) {
  const Vec3l x = point_l(family, t);
  return normal_l(family.lines[1], x).cross(normal_l(family.lines[2], x));
}

/// Distance of two lines, the first through x along v.
long double distance_of_lines(const Vec3l& x, const Vec3l& v, const Line3& f) {
  const Vec3l n = v.cross(f.direction.cast<long double>());
  return std::abs(n.dot(f.point.cast<long double>() - x)) / n.norm();
}

TEST(CriticalConic, VanishesWhereTheTransversalsMeetThePlane) {
  Random random(1);
  int compared = 0;
  for (int round = 0; round < 300; ++round) {
    const auto lines = random_lines(random);
    const PlaneFrame plane = random_plane(random);
    const Conic conic = critical_conic(lines, plane);
    const LineFamily family = line_family(lines);
    double largest = 0;
    for (const double c : {conic.constant, conic.u, conic.v, conic.uu, conic.uv, conic.vv})
      largest = std::max(largest, std::abs(c));
    EXPECT_EQ(largest, 1);
    for (double t = -1; t <= 1; t += 0.25) {
      const Vec3 x = point(family, t), v = direction(family, t).normalized();
      const double along = -plane.height(x) / plane.normal.dot(v);
      if (!(std::abs(along) < 20)) continue;
      const Vec2 q = plane.to_plane(x + along * v);
      const double size = std::max(1.0, q.squaredNorm());
      EXPECT_NEAR(value(conic, q), 0, 1e-10 * size) << round;
      ++compared;
    }
  }
  EXPECT_GT(compared, 1500);
}

TEST(CriticalConic, IsTheDeterminantEverywhereUpToAFactor) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const auto lines = random_lines(random);
    const PlaneFrame plane = random_plane(random);
    const Conic conic = critical_conic(lines, plane);
    long double factor = 0;
    for (int k = 0; k < 10; ++k) {
      const Vec2 q(random(-2, 2), random(-2, 2));
      const Vec3l x = plane.to_space(q).cast<long double>();
      const long double q_value =
          normal_l(lines[0], x).dot(normal_l(lines[1], x).cross(normal_l(lines[2], x)));
      if (std::abs(value(conic, q)) < 0.05) continue;
      const long double ratio = q_value / value(conic, q);
      if (factor == 0) factor = ratio;
      EXPECT_NEAR(static_cast<double>(ratio / factor), 1, 1e-11) << round;
    }
  }
}

TEST(CriticalConic, GradientIsItsDerivative) {
  Random random(3);
  const Conic conic = critical_conic(random_lines(random), random_plane(random));
  for (int k = 0; k < 20; ++k) {
    const Vec2 q(random(-2, 2), random(-2, 2)), d(random(-1, 1), random(-1, 1));
    EXPECT_NEAR(gradient(conic, q).dot(d), value(conic, q + 0.5 * d) - value(conic, q - 0.5 * d),
                1e-13);  // central differences of a quadratic are exact
  }
}

TEST(CriticalConic, OfLinesThatMeetIsAPairOfStraightLines) {
  // Two lines through a vertex: the plane of both, and that of the vertex and the third line.
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    const Vec3 vertex = random.in_box({-1, -1, 0}, {1, 1, 1});
    std::array<Line3, 3> lines = random_lines(random);
    lines[0].point = vertex + 0.7 * lines[0].direction;
    lines[1].point = vertex - 0.3 * lines[1].direction;
    const PlaneFrame plane = random_plane(random);
    const Conic conic = critical_conic(lines, plane);
    const Vec3 both = lines[0].direction.cross(lines[1].direction).normalized();
    const Vec3 wedge = (lines[2].point - vertex).cross(lines[2].direction).normalized();
    double factor = 0;
    for (int k = 0; k < 10; ++k) {
      const Vec2 q(random(-2, 2), random(-2, 2));
      const Vec3 x = plane.to_space(q) - vertex;
      const double product = both.dot(x) * wedge.dot(x);
      if (std::abs(product) < 0.05) continue;
      if (factor == 0) factor = value(conic, q) / product;
      EXPECT_NEAR(value(conic, q), factor * product, 1e-10 * std::abs(factor));
    }
  }
}

TEST(CriticalConic, IsZeroIfTwoLinesCoincide) {
  Random random(5);
  std::array<Line3, 3> lines = random_lines(random);
  lines[2] = {lines[0].point + 2 * lines[0].direction, -3 * lines[0].direction};
  const Conic conic = critical_conic(lines, random_plane(random));
  for (const double c : {conic.constant, conic.u, conic.v, conic.uu, conic.uv, conic.vv})
    EXPECT_EQ(c, 0);
}

TEST(CriticalConic, DoesNotDependOnTheUnitOfLength) {
  Random random(6);
  const auto lines = random_lines(random);
  const PlaneFrame plane = random_plane(random);
  for (const double unit : {1e-8, 1e8}) {
    auto scaled = lines;
    for (Line3& line : scaled) line.point *= unit;
    PlaneFrame moved = plane;
    moved.origin *= unit;
    const Conic a = critical_conic(lines, plane), b = critical_conic(scaled, moved);
    const double same = b.uv / a.uv;
    EXPECT_NEAR(b.constant / (a.constant * same * unit * unit), 1, 1e-9);
    EXPECT_NEAR(b.v / (a.v * same * unit), 1, 1e-9);
    EXPECT_NEAR(b.uu / (a.uu * same), 1, 1e-9);
  }
}

TEST(LineFamily, DirectionMeetsAllThreeLines) {
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    const LineFamily family = line_family(random_lines(random));
    const double t = random(-1, 1);
    const Vec3l v = direction(family, t).cast<long double>(), x = point_l(family, t);
    EXPECT_NEAR(static_cast<double>((v - direction_l(family, t)).norm()), 0, 1e-13);
    for (const std::size_t i : {1u, 2u})
      EXPECT_NEAR(static_cast<double>(distance_of_lines(x, v, family.lines[i])), 0,
                  1e-12 / std::min(1.0, direction(family, t).norm()));
  }
}

TEST(LineFamily, MeetsTheOtherLinesAtTheirParameters) {
  Random random(8);
  for (int round = 0; round < 200; ++round) {
    const LineFamily family = line_family(random_lines(random));
    for (const int i : {1, 2}) {
      const double t = random(-1, 1);
      const LinearRatio ratio = parameter_on(family, i);
      if (std::abs(ratio.c + ratio.d * t) < 0.05) continue;
      const Line3& line = family.lines[static_cast<std::size_t>(i)];
      const Vec3l y = (line.point + value(ratio, t) * line.direction).cast<long double>();
      const Vec3l v = direction_l(family, t), x = point_l(family, t);
      EXPECT_NEAR(static_cast<double>(v.cross(y - x).norm() / v.norm()), 0, 1e-11) << round;
    }
  }
}

TEST(LineFamily, ConditionForAFourthLineIsQuadratic) {
  // The quadratic agrees with the determinant, whose third differences vanish, at many places.
  Random random(9);
  for (int round = 0; round < 300; ++round) {
    const LineFamily family = line_family(random_lines(random));
    const Line3 f = random_line(random);
    const Quadratic c = meeting(family, f);
    for (int k = -8; k <= 8; ++k)
      EXPECT_NEAR(value(c, 0.5 * k), static_cast<double>(determinant(family, f, 0.5 * k)),
                  1e-12 * (1 + std::abs(c[0]) + 4 * std::abs(c[1]) + 16 * std::abs(c[2])));
  }
}

TEST(LineFamily, RootsMeetTheFourthLine) {
  Random random(10);
  int found = 0;
  for (int round = 0; round < 500; ++round) {
    const LineFamily family = line_family(random_lines(random));
    const Line3 f = random_line(random);
    const QuadraticRoots at = roots(meeting(family, f));
    for (int k = 0; k < at.count; ++k) {
      const double t = at.at[static_cast<std::size_t>(k)];
      const double gap = std::abs(at.at[1] - at.at[0]);  // near double roots: half the digits
      if (std::abs(t) > 10 || gap < 1e-2) continue;
      const Vec3l v = direction_l(family, t);
      if (v.norm() < 1e-2 || v.cross(f.direction.cast<long double>()).norm() < 1e-2 * v.norm())
        continue;
      EXPECT_LT(distance_of_lines(point_l(family, t), v, f), 1e-9) << round;
      ++found;
    }
  }
  EXPECT_GT(found, 200);
}

TEST(LineFamily, FindsTheLineThatWasMadeToMeetFour) {
  Random random(11);
  for (int round = 0; round < 300; ++round) {
    const Vec3 base = random.in_box({-1, -1, -1}, {1, 1, 1}), v = random.direction();
    const auto through = [&](double height) {
      const Vec3 d = random(0.3, 2) * random.direction();
      return Line3{base + height * v + random(-1, 1) * d, d};
    };
    const std::array<Line3, 3> lines = {through(0), through(1), through(2.5)};
    const QuadraticRoots at = roots(meeting(line_family(lines), through(-1)));
    const double expected =
        (base - lines[0].point).dot(lines[0].direction) / lines[0].direction.squaredNorm();
    double off = std::numeric_limits<double>::infinity();
    for (int k = 0; k < at.count; ++k)
      off = std::min(off, std::abs(at.at[static_cast<std::size_t>(k)] - expected));
    EXPECT_LT(off, 1e-7) << round;
  }
}

TEST(LineFamily, ALineOfTheFamilyIsMetEverywhere) {
  Random random(12);
  for (int round = 0; round < 100; ++round) {
    const LineFamily family = line_family(random_lines(random));
    for (const Line3& line : family.lines) {
      const Line3 same = {line.point + random(-1, 1) * line.direction, 2 * line.direction};
      EXPECT_TRUE(roots(meeting(family, same)).everywhere) << round;
    }
  }
}

TEST(LineFamily, ComponentAlongAVectorIsThatOfTheDirection) {
  Random random(13);
  for (int round = 0; round < 100; ++round) {
    const LineFamily family = line_family(random_lines(random));
    const Vec3 m = random.direction();
    const double t = random(-2, 2);
    EXPECT_NEAR(value(direction_along(family, m), t), direction(family, t).dot(m), 1e-12);
  }
}

TEST(LineFamily, IsInAPlaneThroughTheSecondLineOrParallelToIt) {
  Random random(14);
  for (int round = 0; round < 100; ++round) {
    const LineFamily family = line_family(random_lines(random));
    const Line3& first = family.lines[0];
    const Line3& second = family.lines[1];
    const Vec3 m = second.direction.cross(random.direction()).normalized();
    const double in_plane = m.dot(second.point - first.point) / m.dot(first.direction);
    const LinearRatio ratio = parameter_on(family, 1);
    const double parallel = -ratio.c / ratio.d;
    const QuadraticRoots at = roots(direction_along(family, m));
    ASSERT_EQ(at.count, 2);
    const double scale = 1e-9 * (1 + std::abs(in_plane) + std::abs(parallel));
    const double gap = 1 / std::min(1.0, std::abs(in_plane - parallel));
    EXPECT_NEAR(at.at[0], std::min(in_plane, parallel), scale * gap) << round;
    EXPECT_NEAR(at.at[1], std::max(in_plane, parallel), scale * gap) << round;
  }
}

TEST(QuadraticRoots, AreThoseOfTheFactors) {
  Random random(15);
  for (int round = 0; round < 1000; ++round) {
    // Dyadic factors, so that the coefficients are exact.
    const double r = std::ldexp(std::floor(random(-1000, 1000)), static_cast<int>(random(-8, 8)));
    const double s = std::ldexp(std::floor(random(-1000, 1000)), static_cast<int>(random(-8, 8)));
    const double a = std::floor(random(1, 9)) * (random(-1, 1) < 0 ? -1 : 1);
    const QuadraticRoots at = roots({a * r * s, -a * (r + s), a});
    ASSERT_EQ(at.count, r == s ? 1 : 2);
    EXPECT_NEAR(at.at[0], std::min(r, s), 1e-15 * std::abs(std::min(r, s)));
    if (r != s) {
      EXPECT_NEAR(at.at[1], std::max(r, s), 1e-15 * std::abs(std::max(r, s)));
    }
  }
}

TEST(QuadraticRoots, KeepAllDigitsOfASmallOne) {
  const QuadraticRoots at = roots({1, -1e9, 1});
  ASSERT_EQ(at.count, 2);
  EXPECT_NEAR(at.at[0] * 1e9, 1 + 1e-18, 1e-15);
  EXPECT_NEAR(at.at[1] * 1e-9, 1, 1e-15);
}

TEST(QuadraticRoots, OfDegenerateOnes) {
  EXPECT_TRUE(roots({0, 0, 0}).everywhere);
  EXPECT_FALSE(roots({1, 0, 0}).everywhere);
  EXPECT_EQ(roots({1, 0, 0}).count, 0);
  EXPECT_EQ(roots({1, 0, 1}).count, 0);
  EXPECT_EQ(roots({-3, 2, 0}).count, 1);
  EXPECT_EQ(roots({-3, 2, 0}).at[0], 1.5);
  EXPECT_EQ(roots({0, 0, 5}).count, 1);
  EXPECT_EQ(roots({0, 0, 5}).at[0], 0);
  EXPECT_EQ(roots({0, 3, 1}).at[0], -3);
  EXPECT_EQ(roots({0, 3, 1}).at[1], 0);
  EXPECT_EQ(roots({-4, 0, 1}).at[0], -2);
  // Out of the range in which squares can be formed.
  EXPECT_EQ(roots({-4e200, 0, 1e200}).at[1], 2);
  EXPECT_EQ(roots({-4e-300, 0, 1e-300}).at[1], 2);
  // A double root that rounding has made complex.
  const double third = 1. / 3;
  const QuadraticRoots at = roots({third * third * (1 + 2e-16), -2 * third, 1});
  EXPECT_EQ(at.count, 1);
  EXPECT_NEAR(at.at[0], third, 1e-15);
}

}  // namespace
}  // namespace halfshade
