#include "meshing/quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

TEST(MinAngle, KnownTriangles) {
  EXPECT_NEAR(min_angle_degrees({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, std::sqrt(0.75), 0)}), 60,
              1e-12);
  EXPECT_NEAR(min_angle_degrees({Vec3(0, 0, 5), Vec3(3, 0, 5), Vec3(0, 3, 5)}), 45, 1e-12);
  // 3-4-5: the smallest angle lies opposite the shortest side.
  EXPECT_NEAR(min_angle_degrees({Vec3(0, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, 3)}),
              std::asin(0.6) * 180 / M_PI, 1e-12);
}

TEST(MinAngle, DoesNotDependOnScaleOrOrder) {
  const Vec3 a(1, 2, 3), b(4, -1, 0.5), c(-2, 0, 1);
  const double angle = min_angle_degrees({a, b, c});
  EXPECT_NEAR(min_angle_degrees({c, b, a}), angle, 1e-12);
  for (const double scale : {1e-200, 1e-5, 1e200})
    EXPECT_NEAR(min_angle_degrees({scale * a, scale * b, scale * c}), angle, 1e-12) << scale;
}

TEST(MinAngle, ZeroWithoutArea) {
  const Vec3 a(1, 2, 3);
  EXPECT_EQ(min_angle_degrees({a, a, a}), 0);
  EXPECT_EQ(min_angle_degrees({a, a, Vec3(0, 0, 0)}), 0);
  EXPECT_NEAR(min_angle_degrees({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)}), 0, 1e-12);
}

TEST(QualitySummary, FindsTheWorstElement) {
  ElementTable table;
  table.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, std::sqrt(0.75), 0}, {4, 0, 0}};
  table.corners = {{0, 1, 3}, {0, 1, 2}, {0, 4, 2}};
  const QualitySummary summary = summarize_quality(table);
  const double worst = std::atan(0.25) * 180 / M_PI;
  EXPECT_EQ(summary.worst_element, 2);
  EXPECT_NEAR(summary.min_angle, worst, 1e-12);
  EXPECT_NEAR(summary.mean_angle, (60 + 45 + worst) / 3, 1e-12);
  EXPECT_NEAR(summary.longest_edge, std::sqrt(17), 1e-12);
  EXPECT_EQ(summary.histogram[2], 1u);  // 14 degrees
  EXPECT_EQ(summary.histogram[8] + summary.histogram[9], 1u);
  EXPECT_EQ(summary.histogram[11], 1u);
}

TEST(QualitySummary, EmptyMeshHasNoWorstElement) {
  EXPECT_EQ(summarize_quality({}).worst_element, -1);
}

}  // namespace
}  // namespace halfshade
