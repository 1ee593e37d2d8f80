#include "meshing/events/swath.h"

#include "tests/support/random_swaths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

// Families of lines, against samples of them.

namespace halfshade {
namespace {

using test::emitter;
using test::Random;
using test::random_fan;
using test::random_fan_of_two;
using test::random_ruled;
using test::random_span;
using test::random_swath;

double distance_to_line(const Vec3& p, const SightLine& line) {
  return (p - line.start).cross(line.direction).norm();
}

/// Where two lines are nearest to each other: parameters on both.
Vec2 nearest(const Vec3& x, const Vec3& u, const Vec3& y, const Vec3& v) {
  const Vec3 normal = u.cross(v), gap = y - x;
  return Vec2(gap.cross(v).dot(normal), gap.cross(u).dot(normal)) / normal.squaredNorm();
}

double distance_of_lines(const Vec3& x, const Vec3& u, const Vec3& y, const Vec3& v) {
  return std::abs((y - x).dot(u.cross(v).normalized()));
}

/// Where the plane through x and the edge a meets the line of the edge b.
double across(const Vec3& x, const Span3& a, const Span3& b) {
  const Vec3 normal = (a.from - x).cross(a.to - x);
  return normal.dot(x - b.from) / normal.dot(b.direction());
}

bool has_near(const std::vector<double>& list, double t, double slack) {
  return std::any_of(list.begin(), list.end(), [&](double s) { return std::abs(s - t) <= slack; });
}

TEST(SightLine, OfAFanRunsThroughItsApexAndItsBase) {
  Random random(1);
  for (int round = 0; round < 500; ++round) {
    const Swath swath = random_fan(random);
    const double t = random(0, 1);
    const auto line = line_at(swath, emitter, t);
    ASSERT_TRUE(line);
    const double steep = std::abs(line->direction.z());
    if (steep < 0.01) continue;
    EXPECT_NEAR(distance_to_line(swath.apex, *line), 0, 1e-12 / steep);
    EXPECT_NEAR(distance_to_line(swath.base.at(t), *line), 0, 1e-12 / steep);
    EXPECT_NEAR(line->start.z(), 2, 1e-12 / steep);
    EXPECT_NEAR(line->direction.norm(), 1, 1e-14);
    EXPECT_LT(line->direction.z(), 0);
    const bool apex_is_last = swath.apex.z() < swath.base.at(t).z();
    EXPECT_EQ(line->last, apex_is_last ? swath.apex : swath.base.at(t));
  }
}

TEST(SightLine, MeetsAllThreeEdgesIfTheyReachIt) {
  Random random(2);
  int met = 0, missed = 0;
  for (int round = 0; round < 2000; ++round) {
    const Swath swath = random_ruled(random);
    const double t = random(0, 1);
    const Vec3 x = swath.edges[0].at(t);
    const double third = across(x, swath.edges[1], swath.edges[2]);
    const double second = across(x, swath.edges[2], swath.edges[1]);
    const double depth = std::min({second, 1 - second, third, 1 - third});
    if (!(std::abs(depth) > 1e-6)) continue;
    const auto line = line_at(swath, emitter, t);
    ASSERT_EQ(line.has_value(), depth > 0) << round;
    ++(line ? met : missed);
    if (!line || std::abs(line->direction.z()) < 0.05) continue;
    const std::array<Vec3, 3> points = {x, swath.edges[1].at(second), swath.edges[2].at(third)};
    double farthest = 0;
    for (const Vec3& p : points) {
      EXPECT_NEAR(distance_to_line(p, *line), 0, 1e-9) << round;
      farthest = std::max(farthest, line->direction.dot(p - line->start));
    }
    EXPECT_NEAR(line->direction.dot(line->last - line->start), farthest, 1e-9);
    EXPECT_LT(line->direction.z(), 0);
    EXPECT_NEAR(line->start.z(), 2, 1e-11);
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 200);
}

TEST(SightLine, IsNoneIfItRunsAlongTheEmitter) {
  Swath swath;
  swath.apex = {0, 0, 1};
  swath.base = {{1, -1, 1}, {1, 1, 1}};
  EXPECT_FALSE(line_at(swath, emitter, 0.3));
  swath.base.to.z() = 0.5;
  EXPECT_TRUE(line_at(swath, emitter, 0.3));
}

/// Point and direction of a swath's line, not of unit length but continuous in t.
std::optional<std::array<Vec3, 2>> sample(const Swath& swath, double t) {
  if (swath.is_planar) return std::array<Vec3, 2>{swath.apex, Vec3(swath.base.at(t) - swath.apex)};
  const Vec3 x = swath.edges[0].at(t);
  const double third = across(x, swath.edges[1], swath.edges[2]);
  const double second = across(x, swath.edges[2], swath.edges[1]);
  if (!(std::min({second, 1 - second, third, 1 - third}) > 0)) return std::nullopt;
  return std::array<Vec3, 2>{x, Vec3(swath.edges[2].at(third) - swath.edges[1].at(second))};
}

/// Calls visit(t) at zeros of a function of the swath's line.
template <class Function, class Visit>
void for_zeros(const Swath& swath, Function&& f, Visit&& visit) {
  constexpr int steps = 200;
  const auto value = [&](double t) -> std::optional<double> {
    const auto line = sample(swath, t);
    return line ? std::optional(f((*line)[0], (*line)[1])) : std::nullopt;
  };
  std::optional<double> before;
  for (int k = 0; k <= steps; ++k) {
    double high = static_cast<double>(k) / steps, low = high - 1. / steps;
    const auto here = value(high);
    const bool changes = before && here && (*before > 0) != (*here > 0);
    const bool is_low_positive = changes && *before > 0;
    before = here;
    if (!changes) continue;
    bool is_continuous = true;
    while (high - low > 1e-13 && is_continuous) {
      const double middle = 0.5 * (low + high);
      const auto at = value(middle);
      is_continuous = at.has_value();
      if (at) ((*at > 0) == is_low_positive ? low : high) = middle;
    }
    if (is_continuous) visit(low);
  }
}

TEST(CriticalParameters, HoldEveryPlaceWhereTheLineMeetsAnEdge) {
  Random random(3);
  int met = 0;
  for (int round = 0; round < 1500; ++round) {
    const Swath swath = random_swath(random);
    const Span3 edge = random_span(random);
    std::vector<double> parameters;
    critical_parameters(swath, edge, 1e-9, parameters);
    for (const double t : parameters) EXPECT_TRUE(t > 0 && t < 1);
    const auto side = [&](const Vec3& x, const Vec3& v) {
      return v.cross(edge.direction()).dot(edge.from - x);
    };
    for_zeros(swath, side, [&](double t) {
      const auto [x, v] = *sample(swath, t);
      if (v.cross(edge.direction()).norm() < 1e-2 * v.norm() * edge.direction().norm()) return;
      if (distance_of_lines(x, v, edge.from, edge.direction()) > 1e-6) return;
      const double s = nearest(x, v, edge.from, edge.direction()).y();
      if (s < 1e-6 || s > 1 - 1e-6) return;
      EXPECT_TRUE(has_near(parameters, t, 1e-7)) << round << ": " << t;
      ++met;
    });
  }
  EXPECT_GT(met, 150);
}

TEST(CriticalParameters, HoldTheEndsOfAnEdgeInTheFansPlane) {
  Random random(4);
  for (int round = 0; round < 300; ++round) {
    const Swath swath = random_fan(random);
    const double t0 = random(0.05, 0.95), t1 = random(0.05, 0.95);
    const auto place = [&](double t) -> Vec3 {
      return swath.apex + random(0.3, 2) * (swath.base.at(t) - swath.apex);
    };
    const Span3 edge = {place(t0), place(t1)};
    std::vector<double> parameters;
    critical_parameters(swath, edge, 1e-9, parameters);
    EXPECT_TRUE(has_near(parameters, t0, 1e-9)) << round;
    EXPECT_TRUE(has_near(parameters, t1, 1e-9)) << round;
  }
}

TEST(CriticalParameters, AreNoneForAnEdgeBesideTheFansPlane) {
  Random random(5);
  for (int round = 0; round < 300; ++round) {
    const Swath swath = random_fan(random);
    const Vec3 normal = (swath.base.from - swath.apex).cross(swath.base.to - swath.apex);
    const Vec3 off = 1e-6 * normal.normalized();
    std::vector<double> parameters;
    critical_parameters(swath, {swath.base.at(0.2) + off, swath.base.at(0.8) + off}, 1e-9,
                        parameters);
    EXPECT_TRUE(parameters.empty());
  }
}

TEST(LineAt, MeetsTheSecondEdgeOfAPlane) {
  Random random(16);
  int met = 0;
  for (int round = 0; round < 400; ++round) {
    const Swath swath = random_fan_of_two(random);
    for (const double t : {0.1, 0.4, 0.8})
      if (const auto line = line_at(swath, emitter, t)) {
        const Span3& edge = *swath.second;
        const Vec3 across = line->direction.cross(plane_normal(swath));
        const double from = across.dot(edge.from - line->start),
                     to = across.dot(edge.to - line->start);
        EXPECT_LE(from * to, 1e-12) << "its ends lie on either side";
        ++met;
      }
  }
  EXPECT_GT(met, 200);
}

TEST(OwnLimits, AreWhereTheLineStartsOrCeasesToMeetTheEdges) {
  Random random(6);
  int changes = 0;
  for (int round = 0; round < 800; ++round) {
    const Swath swath = round % 2 == 0 ? random_ruled(random) : random_fan_of_two(random);
    std::vector<double> limits;
    own_limits(swath, limits);
    bool before = sample(swath, 0).has_value();
    for (int k = 1; k <= 100; ++k) {
      const bool here = sample(swath, 0.01 * k).has_value();
      if (here != before) {
        EXPECT_TRUE(has_near(limits, 0.01 * k - 0.005, 0.005 + 1e-9)) << round << ": " << k;
        ++changes;
      }
      before = here;
    }
    // Nothing begins or ends between them.
    limits.insert(limits.end(), {0, 1});
    std::sort(limits.begin(), limits.end());
    for (std::size_t i = 1; i < limits.size(); ++i) {
      const double width = limits[i] - limits[i - 1];
      if (width < 1e-6) continue;
      const bool first = line_at(swath, emitter, limits[i - 1] + 0.01 * width).has_value();
      for (const double share : {0.3, 0.6, 0.99})
        EXPECT_EQ(line_at(swath, emitter, limits[i - 1] + share * width).has_value(), first);
    }
  }
  EXPECT_GT(changes, 500);
}

TEST(GrazingParameters, AreWhereTheLineRunsAlongThePlane) {
  Random random(7);
  int found = 0;
  for (int round = 0; round < 600; ++round) {
    const Swath swath = random_swath(random);
    const Vec3 normal = random.direction();
    std::vector<double> parameters;
    grazing_parameters(swath, normal, parameters);
    const auto along = [&](const Vec3&, const Vec3& v) { return normal.dot(v); };
    for_zeros(swath, along, [&](double t) {
      EXPECT_TRUE(has_near(parameters, t, 1e-7)) << round << ": " << t;
      ++found;
    });
  }
  EXPECT_GT(found, 50);
}

PlaneFrame leaning_floor(Random& random) {
  return make_frame(random.in_box({-1, -1, -1}, {1, 1, 0}),
                    Vec3::UnitZ() + 0.5 * random.direction());
}

TEST(Trace, LiesOnThePlaneAndOnTheLine) {
  Random random(9);
  int compared = 0;
  for (int round = 0; round < 600; ++round) {
    const Swath swath = random_swath(random);
    const PlaneFrame plane = leaning_floor(random);
    const double t = random(0, 1);
    const auto line = line_at(swath, emitter, t);
    if (!line || std::abs(plane.normal.dot(line->direction)) < 0.1) continue;
    if (std::abs(line->direction.z()) < 0.1) continue;
    const auto trace = trace_at(swath, plane, t);
    ASSERT_TRUE(trace);
    EXPECT_NEAR(plane.height(trace->point), 0, 1e-11);
    EXPECT_NEAR(distance_to_line(trace->point, *line), 0, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(Trace, TangentIsTheCentralDifference) {
  Random random(10);
  int compared = 0;
  for (int round = 0; round < 1000; ++round) {
    const Swath swath = random_swath(random);
    const PlaneFrame plane = leaning_floor(random);
    const double t = random(0.1, 0.9), h = 1e-4;
    const auto line = line_at(swath, emitter, t);
    if (!line || std::abs(plane.normal.dot(line->direction)) < 0.2) continue;
    const auto at = [&](double s) { return trace_at(swath, plane, s)->point; };
    const Vec3 near = (at(t + h) - at(t - h)) / (2 * h);
    const Vec3 far = (at(t + 2 * h) - at(t - 2 * h)) / (4 * h);
    const Vec3 expected = (4 * near - far) / 3;
    const double error = (near - far).norm();  // of the cruder ones
    if (error > 1e-2 * (1 + expected.norm())) continue;
    const Vec3 tangent = trace_at(swath, plane, t)->tangent;
    EXPECT_NEAR((tangent - expected).norm(), 0, 1e-8 * (1 + expected.norm()) + 0.05 * error)
        << round;
    EXPECT_NEAR(plane.normal.dot(tangent), 0, 1e-10 * (1 + expected.norm()));
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST(Trace, IsNoneOnAPlaneThatTheLineRunsAlong) {
  Swath swath;
  swath.apex = {0, 0, 2};
  swath.base = {{0, -1, 1}, {0, 1, 1}};
  EXPECT_FALSE(trace_at(swath, make_frame({3, 0, 0}, Vec3::UnitX()), 0.4));
  const auto floor = trace_at(swath, make_frame({3, 0, 0}, Vec3::UnitZ()), 0.75);
  ASSERT_TRUE(floor);
  EXPECT_NEAR((floor->point - Vec3(0, 1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((floor->tangent - Vec3(0, 4, 0)).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace halfshade
