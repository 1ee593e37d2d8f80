#include "meshing/geometry/conic_arc.h"

#include "meshing/core/planar.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

using test::Random;

constexpr double flat = 1e-12;

Vec2 on_circle(double radius, double angle) {
  return radius * Vec2(std::cos(angle), std::sin(angle));
}

Vec2 tangent_of_circle(double angle) { return {-std::sin(angle), std::cos(angle)}; }

/// A conic through trigonometric or hyperbolic functions, placed anywhere.
struct Conic {
  enum class Kind { ellipse, parabola, hyperbola } kind;
  double a, b;
  Eigen::Matrix2d turn;
  Vec2 shift;

  Vec2 point(double t) const {
    if (kind == Kind::ellipse) return shift + turn * Vec2(a * std::cos(t), b * std::sin(t));
    if (kind == Kind::parabola) return shift + turn * Vec2(a * t, b * t * t);
    return shift + turn * Vec2(a * std::cosh(t), b * std::sinh(t));
  }
  Vec2 velocity(double t) const {
    if (kind == Kind::ellipse) return turn * Vec2(-a * std::sin(t), b * std::cos(t));
    if (kind == Kind::parabola) return turn * Vec2(a, 2 * b * t);
    return turn * Vec2(a * std::sinh(t), b * std::cosh(t));
  }
  /// Vanishes on the conic; roughly a distance over the size.
  double residual(const Vec2& p) const {
    const Vec2 q = turn.transpose() * (p - shift);
    const double x = q.x() / a, y = q.y() / b;
    if (kind == Kind::ellipse) return x * x + y * y - 1;
    if (kind == Kind::parabola) return y - x * x;
    return x * x - y * y - 1;
  }
};

Conic random_conic(Random& random, int kind) {
  return {static_cast<Conic::Kind>(kind), random(0.3, 2), random(0.3, 2),
          Eigen::Rotation2Dd(random(0, 6)).toRotationMatrix(), Vec2(random(-3, 3), random(-3, 3))};
}

std::optional<ConicArc> arc_of(const Conic& conic, double t0, double t1, double between) {
  const double t = t0 + between * (t1 - t0), side = t1 > t0 ? 1 : -1;
  return conic_arc(conic.point(t0), side * conic.velocity(t0), conic.point(t), conic.point(t1),
                   2.5 * side * conic.velocity(t1), flat);
}

/// Corners in [−1, 1]², a weight between 10^−d and 10^d.
ConicArc random_arc(Random& random, int d) {
  return {{random(-1, 1), random(-1, 1)},
          {random(-1, 1), random(-1, 1)},
          {random(-1, 1), random(-1, 1)},
          std::pow(10, random(-d, d)),
          false};
}

/// Distance by a fine scan and golden sections: slow, but nothing to get wrong.
double scanned_distance(const ConicArc& arc, const Vec2& q) {
  const auto away = [&](double s) { return (point_at(arc, s) - q).norm(); };
  constexpr int samples = 2000;
  int best = 0;
  for (int i = 1; i <= samples; ++i)
    if (away(i / double(samples)) < away(best / double(samples))) best = i;
  double a = std::max(0, best - 1) / double(samples),
         b = std::min(samples, best + 1) / double(samples);
  for (int i = 0; i < 200; ++i) {
    const double c = a + (b - a) * 0.382, d = a + (b - a) * 0.618;
    (away(c) < away(d) ? b : a) = away(c) < away(d) ? d : c;
  }
  return std::min({away(a), away(b), away(0), away(1)});
}

TEST(ConicArc, OfACircleHasTheCosineOfHalfItsTurnAsWeight) {
  for (const double turn : {1e-5, 1e-3, 0.1, 1.0, 2.0, 2.6}) {
    const double start = 0.7, end = start + turn;
    const auto arc =
        conic_arc(on_circle(2, start), tangent_of_circle(start), on_circle(2, start + 0.3 * turn),
                  on_circle(2, end), tangent_of_circle(end), flat);
    ASSERT_TRUE(arc && !arc->is_straight) << turn;
    EXPECT_NEAR(arc->weight, std::cos(turn / 2), 1e-14 / (turn * turn) + 1e-14) << turn;
    for (const double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      EXPECT_NEAR(point_at(*arc, s).norm(), 2, 1e-14);
      EXPECT_NEAR(tangent_at(*arc, s).dot(point_at(*arc, s)), 0, 1e-15 / turn + 1e-13);
      EXPECT_NEAR(tangent_at(*arc, s).norm(), 1, 1e-14);
      EXPECT_GT(cross_2d(point_at(*arc, s), tangent_at(*arc, s)), 0);
    }
    EXPECT_NEAR(length(*arc), 2 * turn, 4e-6 * turn);
  }
}

TEST(ConicArc, ThroughAnyConicLiesOnIt) {
  Random random(1);
  int found = 0;
  for (int round = 0; round < 3000; ++round) {
    const Conic conic = random_conic(random, round % 3);
    const double t0 = random(-1.5, 1.5), t1 = t0 + random(-1.2, 1.2);
    const auto arc = arc_of(conic, t0, t1, random(0.1, 0.9));
    if (!arc) continue;
    ++found;
    EXPECT_EQ(point_at(*arc, 0), conic.point(t0));
    EXPECT_EQ(point_at(*arc, 1), conic.point(t1));
    for (double s = 0; s <= 1; s += 0.125)
      EXPECT_NEAR(conic.residual(point_at(*arc, s)), 0, 2e-11) << round;
    EXPECT_LT(distance(*arc, conic.point(0.3 * t0 + 0.7 * t1)), 1e-11) << round;
  }
  EXPECT_GT(found, 2900);
}

TEST(ConicArc, KindFollowsFromTheWeight) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const Conic conic = random_conic(random, round % 3);
    const auto arc = arc_of(conic, -0.15, 0.2, 0.5);
    ASSERT_TRUE(arc && !arc->is_straight);
    EXPECT_EQ(arc->weight > 1 + 1e-3, conic.kind == Conic::Kind::hyperbola);
    EXPECT_EQ(arc->weight < 1 - 1e-3, conic.kind == Conic::Kind::ellipse);
    EXPECT_EQ(std::abs(arc->weight - 1) < 1e-12, conic.kind == Conic::Kind::parabola);
  }
}

TEST(ConicArc, IsStraightForPointsOnALine) {
  const Vec2 a(1, 2), d(0.6, -0.8);
  for (const double noise : {0.0, 1e-13, -1e-13}) {
    const Vec2 across = noise * Vec2(0.8, 0.6);
    const auto arc = conic_arc(a, d + across, a + 2 * d + across, a + 5 * d, d - across, flat);
    ASSERT_TRUE(arc);
    EXPECT_TRUE(arc->is_straight);
    EXPECT_NEAR((point_at(*arc, 0.25) - (a + 1.25 * d)).norm(), 0, 1e-15);
    EXPECT_EQ(length(*arc), 5.0);
    EXPECT_EQ(flatten(*arc, 1e-9), (std::vector<double>{0, 1}));
  }
}

TEST(ConicArc, NearlyStraightOnesStayWithinTheTolerance) {
  // Circles of radius up to 1e11 through points about 1 apart, known to rounding only.
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    const double curvature = std::pow(10, random(-16, -1));
    const auto point = [&](double x) {
      const double half = std::sin(x * curvature / 2);
      return Vec2(std::sin(x * curvature) / curvature, 2 * half * half / curvature);
    };
    const auto tangent = [&](double x) {
      return Vec2(std::cos(x * curvature), std::sin(x * curvature) + random(-1, 1) * 1e-15);
    };
    const double middle = random(0.2, 0.8);
    const auto arc = conic_arc(point(0), tangent(0), point(middle), point(1), tangent(1), 1e-13);
    ASSERT_TRUE(arc) << curvature;
    EXPECT_TRUE(arc->is_straight || curvature > 1e-13) << curvature;
    for (double x = 0; x <= 1; x += 0.1) EXPECT_LT(distance(*arc, point(x)), 2e-13) << curvature;
  }
}

TEST(ConicArc, RefusesWhatNoArcOfTheKindCanDo) {
  const Vec2 a(0, 0), b(2, 0);
  // Half a circle; an S; a point on the other side; a point outside the triangle of the tangents.
  EXPECT_FALSE(conic_arc(a, {0, 1}, {1, 1}, b, {0, -1}, flat));
  EXPECT_FALSE(conic_arc(a, {1, 1}, {1, 0.2}, b, {1, 1}, flat));
  EXPECT_FALSE(conic_arc(a, {1, 1}, {1, -0.2}, b, {1, -1}, flat));
  EXPECT_FALSE(conic_arc(a, {1, 1}, {1, 1.2}, b, {1, -1}, flat));
  EXPECT_FALSE(conic_arc(a, {1, 1}, {1, 0}, b, {1, 1}, flat));
  EXPECT_TRUE(conic_arc(a, {1, 1}, {1, 0.8}, b, {1, -1}, flat));
}

TEST(ConicArc, OfALengthBelowTheToleranceIsStraight) {
  const auto arc = conic_arc({0, 0}, {0, 1}, {5e-13, 2e-13}, {9e-13, 0}, {0, -1}, flat);
  ASSERT_TRUE(arc);
  EXPECT_TRUE(arc->is_straight);
}

TEST(ConicArc, PartsAreThePiecesOfTheWhole) {
  Random random(4);
  for (int round = 0; round < 2000; ++round) {
    ConicArc arc = random_arc(random, 2);
    double s0 = random(0, 1), s1 = random(0, 1);
    if (s0 > s1) std::swap(s0, s1);
    const ConicArc piece = part(arc, s0, s1);
    EXPECT_LT((point_at(piece, 0) - point_at(arc, s0)).norm(), 1e-14);
    EXPECT_LT((point_at(piece, 1) - point_at(arc, s1)).norm(), 1e-14);
    // Both parameters of a point of the piece are known from the Möbius map that fixes the ends and
    // scales the outer weights to one.
    const auto w = [&](double s) {
      return (1 - s) * (1 - s) + 2 * s * (1 - s) * arc.weight + s * s;
    };
    const double u = random(0, 1), ratio = std::sqrt(w(s0) / w(s1));
    const double v = u * ratio / (1 - u + u * ratio);
    EXPECT_LT((point_at(piece, u) - point_at(arc, s0 + v * (s1 - s0))).norm(), 1e-12) << round;
  }
}

TEST(ConicArc, DistanceIsThatOfAScan) {
  Random random(5);
  for (int round = 0; round < 400; ++round) {
    const ConicArc arc = random_arc(random, 3);
    const Vec2 q(random(-2, 2), random(-2, 2));
    const double expected = scanned_distance(arc, q);
    EXPECT_LE(distance(arc, q), expected + 1e-12) << round;
    EXPECT_GE(distance(arc, q), expected - 1e-7) << round;
    EXPECT_NEAR((point_at(arc, nearest_parameter(arc, q)) - q).norm(), distance(arc, q), 1e-12);
  }
}

TEST(ConicArc, DistanceVanishesOnTheArcForAnyWeight) {
  Random random(6);
  for (int round = 0; round < 3000; ++round) {
    const ConicArc arc = random_arc(random, 6);
    const double s = random(0, 1);
    EXPECT_LT(distance(arc, point_at(arc, s)), 3e-13) << round;
  }
}

TEST(ConicArc, DistanceFromTheCentreOfACircleIsItsRadius) {
  const auto arc =
      conic_arc({3, 0}, {0, 1}, on_circle(3, 0.5), on_circle(3, 2), tangent_of_circle(2), flat);
  ASSERT_TRUE(arc);
  EXPECT_NEAR(distance(*arc, {0, 0}), 3, 1e-14);
  EXPECT_NEAR(distance(*arc, on_circle(1e-9, 1)), 3 - 1e-9, 1e-14);
  EXPECT_NEAR(distance(*arc, on_circle(5, 1.2)), 2, 1e-14);
  EXPECT_NEAR(distance(*arc, {3, -4}), 4, 1e-14);
  EXPECT_NEAR(distance(straight_arc({0, 0}, {2, 0}), {1, 0.5}), 0.5, 0);
  EXPECT_NEAR(distance(straight_arc({0, 0}, {2, 0}), {5, 4}), 5, 0);
}

TEST(ConicArc, FlatteningKeepsTheDeviationAndWastesLittle) {
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    const ConicArc arc = random_arc(random, 2);
    const double deviation = std::pow(10, random(-5, -1));
    const std::vector<double> ends = flatten(arc, deviation);
    ASSERT_GE(ends.size(), 2u);
    EXPECT_EQ(ends.front(), 0);
    EXPECT_EQ(ends.back(), 1);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      ASSERT_LT(ends[i], ends[i + 1]);
      const ConicArc chord = straight_arc(point_at(arc, ends[i]), point_at(arc, ends[i + 1]));
      for (const double u : {0.2, 0.5, 0.7}) {
        EXPECT_LE(distance(chord, point_at(arc, ends[i] + u * (ends[i + 1] - ends[i]))),
                  deviation * (1 + 1e-12));
        EXPECT_LE(distance(arc, point_at(chord, u)), deviation * (1 + 1e-12));
      }
    }
  }
}

TEST(ConicArc, FlatteningOfACircleTakesTheNumberOfChordsHalvingNeeds) {
  const auto arc = conic_arc({1, 0}, {0, 1}, on_circle(1, 0.5), {0, 1}, {-1, 0}, flat);
  ASSERT_TRUE(arc);
  for (const double deviation : {0.5, 1e-2, 1e-4, 1e-8}) {
    std::size_t chords = 1;  // a chord over the angle a strays by 1 − cos(a/2)
    while (2 * std::pow(std::sin(std::numbers::pi / 8 / double(chords)), 2) > deviation)
      chords *= 2;
    EXPECT_EQ(flatten(*arc, deviation).size(), chords + 1) << deviation;
  }
}

TEST(ConicArc, FlatteningEndsForAnyDeviation) {
  const ConicArc arc = {{0, 0}, {1, 1}, {2, 0}, 0.7, false};
  EXPECT_LE(flatten(arc, 1e-300).size(), (1u << 20) + 1);
  EXPECT_EQ(flatten({{1, 1}, {1, 1}, {1, 1}, 1, false}, 1e-9).size(), 2u);
}

}  // namespace
}  // namespace halfshade
