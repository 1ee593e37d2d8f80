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

std::vector<EmitterPart> parts_of(const SurfacePoint& point, const EmitterTarget& target) {
  std::vector<EmitterPart> parts;
  add_parts(point, triangles_of(target), parts);
  return parts;
}

std::vector<LightPoint> drawn(const std::vector<EmitterPart>& parts) {
  constexpr int count = 4000;
  const LightDraw light(parts);
  SpreadPairs pairs(5);
  std::vector<LightPoint> points;
  for (int k = 0; k < count; ++k) {
    const auto [s, t] = pairs.next();
    points.push_back(light.point(s, t));
  }
  return points;
}

/// Of the light of a strip, what comes from x up to one, against closed forms.
void expect_light_up_to(double x, const SurfacePoint& point, const EmitterTarget& target,
                        const std::vector<LightPoint>& points) {
  const auto& r = target.rings[0];
  const std::vector<std::vector<Vec3>> below = {
      {r[0], r[1], {x, r[1].y(), r[1].z()}, {x, r[0].y(), r[0].z()}}};
  const double share = unobstructed_factor(point.position, point.normal, below) /
                       unobstructed_factor(point.position, point.normal, target.rings);
  double sum = 0, all = 0;
  for (const LightPoint& p : points) {
    all += p.weight;
    if (point.position.x() + p.way.x() < x) sum += p.weight;
  }
  EXPECT_NEAR(sum / all, share, 0.01) << point.position.transpose() << " to " << x;
}

void expect_even_weights(const SurfacePoint& point, const EmitterTarget& target,
                         const std::vector<LightPoint>& points) {
  double least = HUGE_VAL, most = 0;
  for (const LightPoint& p : points) {
    EXPECT_GE(light_along(point, target, p.way), 0);
    least = std::min(least, p.weight);
    most = std::max(most, p.weight);
  }
  EXPECT_LT(most, 2.6 * least);
}

TEST(EmitterParts, PointsAreAsLikelyAsTheLightFromThem) {
  test::Random random(3);
  int cut_by_horizon = 0;
  for (int k = 0; k < 300; ++k) {
    const EmitterTarget target =
        strip(std::pow(10, random(-3, 0.3)), random(1, 10), std::pow(10, random(-1, 1)));
    const Vec3 normal = Vec3(random(-1, 1), random(-1, 1), random(0, 1)).normalized();
    const SurfacePoint point{{random(-3, 9), random(-3, 3), 0}, normal};
    const std::vector<EmitterPart> parts = parts_of(point, target);
    const double whole = unobstructed_factor(point.position, point.normal, target.rings);
    ASSERT_EQ(parts.empty(), !(whole > 0));
    if (parts.empty()) continue;
    const std::vector<LightPoint> points = drawn(parts);
    const double length = target.rings[0][2].x();
    for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9})
      expect_light_up_to(share * length, point, target, points);
    expect_even_weights(point, target, points);
    cut_by_horizon +=
        std::any_of(target.rings[0].begin(), target.rings[0].end(),
                    [&](const Vec3& corner) { return normal.dot(corner - point.position) < 0; });
  }
  EXPECT_GT(cut_by_horizon, 50);
}

TEST(EmitterParts, DrawLightVeryCloseToTheEmitter) {
  // Below the emitter, below its border, and where the horizon cuts it.
  for (const double gap : {1e-3, 1e-6, 1e-9}) {
    const EmitterTarget target = strip(gap, 1, 1);
    for (const SurfacePoint& point : {SurfacePoint{{0.4, 0.3, 0}, Vec3::UnitZ()},
                                      SurfacePoint{{1 - gap, 0.3, 0}, Vec3::UnitZ()},
                                      SurfacePoint{{0.4, 0.3, 0}, Vec3(-1, 0, gap).normalized()}}) {
      const std::vector<LightPoint> points = drawn(parts_of(point, target));
      for (const double x : {-1.5, -0.5, 0.5, 1.5})
        expect_light_up_to(std::min(point.position.x() + x * gap, 1.), point, target, points);
      expect_even_weights(point, target, points);
    }
  }
}

TEST(EmitterParts, NoneWhereThereIsNoLight) {
  EXPECT_TRUE(parts_of({{0.5, 0.5, 2}, Vec3::UnitZ()}, strip(1, 1, 1)).empty());
  // In a corner of the emitter.
  EXPECT_TRUE(parts_of({{0, 0, 1}, Vec3::UnitX()}, strip(1, 1, 1)).empty());
}

}  // namespace
}  // namespace halfshade
