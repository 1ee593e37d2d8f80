#include "solver/direct/emitter_parts.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/geometry/spread_pairs.h"
#include "solver/direct/ray_emitter.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

/// A strip that looks down from a height, so long and wide.
EmitterTarget strip(double height, double length, double width) {
  EmitterTarget target;
  target.rings = {
      {{0, 0, height}, {0, width, height}, {length, width, height}, {length, 0, height}}};
  target.normal = -Vec3::UnitZ();
  target.origin = target.rings[0][0];
  return target;
}

Triangles triangles_of(const EmitterTarget& target) {
  const std::vector<Vec3>& r = target.rings[0];
  return {{r[0], r[1], r[2]}, {r[0], r[2], r[3]}};
}

double least_light(const SurfacePoint& point, const EmitterTarget& target,
                   const std::array<Vec3, 3>& triangle) {
  double least = HUGE_VAL;
  for (const Vec3& corner : triangle)
    least = std::min(least, light_along(point, target, corner - point.position));
  return least;
}

TEST(EmitterParts, AreEvenOrNegligibleAndSumToTheWhole) {
  test::Random random(3);
  int cut = 0;
  for (int k = 0; k < 600; ++k) {
    const EmitterTarget target = strip(random(0.5, 2), random(1, 10), 0.3);
    const Vec3 normal = Vec3(random(-1, 1), random(-1, 1), random(0, 1)).normalized();
    const SurfacePoint point{{random(-3, 9), random(-3, 3), 0}, normal};
    const double whole = unobstructed_factor(point.position, point.normal, target.rings);
    std::vector<EmitterPart> parts(1);  // others are left alone
    constexpr double negligible = 0.01;
    ASSERT_TRUE(cut_evenly(point, target, triangles_of(target), negligible, parts));
    double sum = 0;
    for (std::size_t p = 1; p < parts.size(); ++p) {
      sum += parts[p].factor;
      if (parts[p].factor < negligible) continue;
      test::Random places(p);
      const auto& [a, b, c] = parts[p].triangle;
      const double least = least_light(point, target, parts[p].triangle);
      double mean = 0;
      constexpr int count = 2000;
      for (int i = 0; i < count; ++i) {
        const double r = std::sqrt(places(0, 1)), t = places(0, 1);
        const Vec3 q = a + r * (b - a + t * (c - b));
        mean += light_along(point, target, q - point.position) / count;
      }
      EXPECT_LT(mean, 3.1 * least);
      for (const Vec3& corner : parts[p].triangle)
        EXPECT_LE(light_along(point, target, corner - point.position), 3 * least);
    }
    EXPECT_NEAR(sum, whole, 1e-12);
    cut += parts.size() > 3;
  }
  EXPECT_GT(cut, 100);
}

TEST(EmitterParts, NoticeWhatIsCloseToTheMiddle) {
  // All corners give the same light, the middle a thousand times as much.
  const EmitterTarget target = strip(1, 10, 10);
  const SurfacePoint below{{5, 5, 0}, Vec3::UnitZ()};
  const double factor = unobstructed_factor(below.position, below.normal, target.rings);
  EXPECT_FALSE(is_even(below, target, 100, factor));
  const SurfacePoint far{{5, 5, -50}, Vec3::UnitZ()};
  EXPECT_TRUE(
      is_even(far, target, 100, unobstructed_factor(far.position, far.normal, target.rings)));
}

TEST(EmitterParts, GivesUpVeryCloseToTheEmitter) {
  const EmitterTarget target = strip(1e-3, 1, 1);
  const SurfacePoint below{{0.4, 0.3, 0}, Vec3::UnitZ()};
  std::vector<EmitterPart> parts(1);
  EXPECT_FALSE(cut_evenly(below, target, triangles_of(target), 1e-6, parts));
  EXPECT_EQ(parts.size(), 1U);
}

constexpr int pairs_drawn = 4000;

std::vector<std::array<double, 2>> even_pairs() {
  SpreadPairs next(5);
  std::vector<std::array<double, 2>> pairs;
  for (int k = 0; k < pairs_drawn; ++k) pairs.push_back(next.next());
  return pairs;
}

TEST(EmitterParts, PointsAreAsLikelyAsTheLightFromThem) {
  // Close below the emitter, below its border, and where the horizon cuts it.
  const EmitterTarget target = strip(1e-3, 1, 1);
  for (const SurfacePoint& point :
       {SurfacePoint{{0.4, 0.3, 0}, Vec3::UnitZ()}, SurfacePoint{{0.999, 0.3, 0}, Vec3::UnitZ()},
        SurfacePoint{{0.4, 0.3, 0}, Vec3(-1, 0, 1e-3).normalized()}}) {
    std::vector<std::array<double, 2>> pairs = even_pairs();
    std::vector<LightPoint> points;
    add_points_by_light(point, target, triangles_of(target), pairs, points);
    ASSERT_EQ(points.size(), std::size_t{pairs_drawn});
    const auto factor_of = [&](double from, double to) {
      const std::vector<std::vector<Vec3>> ring = {
          {{from, 0, 1e-3}, {from, 1, 1e-3}, {to, 1, 1e-3}, {to, 0, 1e-3}}};
      return unobstructed_factor(point.position, point.normal, ring);
    };
    for (const double x : {0.3985, 0.3995, 0.4005, 0.402, 0.9985, 0.9995}) {
      double sum = 0;
      for (const LightPoint& p : points)
        if (p.position.x() < x) sum += p.weight / pairs_drawn;
      EXPECT_NEAR(sum, factor_of(0, x) / factor_of(0, 1), 0.01) << point.position.x() << " " << x;
    }
    EXPECT_TRUE(std::all_of(points.begin(), points.end(), [&](const LightPoint& p) {
      return p.weight > 0.3 && light_along(point, target, p.position - point.position) > 0;
    }));
  }
}

TEST(EmitterParts, NoPointsWhereThereIsNoLight) {
  const EmitterTarget target = strip(1, 1, 1);
  std::vector<std::array<double, 2>> pairs = even_pairs();
  std::vector<LightPoint> points;
  add_points_by_light({{0.5, 0.5, 2}, Vec3::UnitZ()}, target, triangles_of(target), pairs, points);
  EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace halfshade
