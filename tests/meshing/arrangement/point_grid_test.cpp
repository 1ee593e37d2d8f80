#include "meshing/arrangement/point_grid.h"

#include <gtest/gtest.h>

#include <random>

namespace halfshade {
namespace {

TEST(PointGrid, FindsTheNearestThatComparingAllFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] {
    const double x = uniform(random);
    return Vec2(x, uniform(random));
  };
  PointGrid grid(0.1);
  std::vector<Vec2> points;
  for (int i = 0; i < 500; ++i) {
    points.push_back(point());
    grid.add(i, points.back());
  }
  for (int k = 0; k < 200; ++k) {
    const Vec2 p = point();
    const double radius = k % 2 == 0 ? 0.1 : 0.04;
    int expected = -1, within = 0, found = 0;
    for (int i = 0; i < 500; ++i) {
      const double distance = (points[at(i)] - p).norm();
      if (distance > radius) continue;
      ++within;
      if (i % 3 != 0 && (expected < 0 || distance < (points[at(expected)] - p).norm()))
        expected = i;
    }
    EXPECT_EQ(grid.nearest(p, radius, [](int i, double) { return i % 3 != 0; }), expected);
    grid.for_each_near(p, radius, [&](int i, double distance) {
      EXPECT_DOUBLE_EQ(distance, (points[at(i)] - p).norm());
      ++found;
    });
    EXPECT_EQ(found, within);
  }
}

TEST(PointGrid, OfPointsInOnePlaceGivesTheFirst) {
  PointGrid grid(1);
  for (const int id : {7, 3, 5}) grid.add(id, {0.5, 0.5});
  EXPECT_EQ(grid.nearest({0.5, 0.5}, 1, [](int, double) { return true; }), 3);
}

}  // namespace
}  // namespace halfshade
