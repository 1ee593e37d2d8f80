#include "meshing/geometry/convex_hull.h"

#include "meshing/core/planar.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace halfshade {
namespace {

TEST(ConvexHull, HoldsAllPointsOnItsLeftAndTurnsLeft) {
  test::Random random(4);
  for (int round = 0; round < 200; ++round) {
    std::vector<Vec2> points;
    const int count = random.integer(3, 20);
    for (int k = 0; k < count; ++k)  // on a grid: many are collinear, some the same
      points.emplace_back(random.integer(-3, 3), random.integer(-3, 3));
    points.insert(points.end(), {Vec2(-3, -3), Vec2(3, -2), Vec2(0, 3)});
    std::vector<Vec2> hull;
    for (const std::size_t k : convex_hull(points)) hull.push_back(points[k]);
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Vec2 &a = hull[k], &b = hull[(k + 1) % hull.size()], &c = hull[(k + 2) % hull.size()];
      EXPECT_GT(cross_2d(b - a, c - b), 0);
      EXPECT_TRUE(std::find(points.begin(), points.end(), a) != points.end());
      for (const Vec2& p : points) EXPECT_GE(cross_2d(b - a, p - a), 0);
    }
  }
}

TEST(ConvexHull, LeavesOutWhatLiesOnItsSides) {
  const std::vector<Vec2> points = {{1, 0}, {2, 2}, {0, 0}, {2, 0}, {0, 2}, {1, 1}, {2, 1}};
  EXPECT_EQ(convex_hull(points), (std::vector<std::size_t>{2, 3, 1, 4}));
}

}  // namespace
}  // namespace halfshade
