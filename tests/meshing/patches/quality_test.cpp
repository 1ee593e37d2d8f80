#include "meshing/patches/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

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

// Triangles of one plane with constrained edges given as pairs of points.
ElementTable plane_table(const std::vector<Vec3>& points,
                         const std::vector<std::array<int, 3>>& corners,
                         const std::set<std::pair<int, int>>& constrained) {
  ElementTable table;
  table.points = points;
  table.corners = corners;
  for (int e = 0; e < table.count(); ++e) {
    const auto [a, b, c] = table.triangle(e);
    table.area.push_back(0.5 * (b - a).cross(c - a).norm());
    std::array<int, 3> neighbours{-1, -1, -1}, order{-1, -1, -1};
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = corners[static_cast<std::size_t>(e)][k];
      const int q = corners[static_cast<std::size_t>(e)][(k + 1) % 3];
      for (int f = 0; f < table.count(); ++f) {
        const auto& other = corners[static_cast<std::size_t>(f)];
        if (f != e && std::count(other.begin(), other.end(), p) == 1 &&
            std::count(other.begin(), other.end(), q) == 1)
          neighbours[k] = f;
      }
      if (neighbours[k] < 0) order[k] = 0;
      if (constrained.contains(std::minmax(p, q))) order[k] = 2;
    }
    table.neighbours.push_back(neighbours);
    table.edge_order.push_back(order);
  }
  return table;
}

// A square of eight triangles around its middle, point 0.
ElementTable square(const std::set<std::pair<int, int>>& constrained) {
  return plane_table(
      {{0, 0, 0},
       {1, 0, 0},
       {1, 1, 0},
       {0, 1, 0},
       {-1, 1, 0},
       {-1, 0, 0},
       {-1, -1, 0},
       {0, -1, 0},
       {1, -1, 0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}, {0, 7, 8}, {0, 8, 1}},
      constrained);
}

TEST(InputAngles, RightAnglesAndStraightLinesAreNone) {
  for (const auto& lines : std::vector<std::set<std::pair<int, int>>>{
           {}, {{0, 1}}, {{0, 1}, {0, 3}}, {{0, 1}, {0, 5}}, {{0, 1}, {0, 3}, {0, 5}, {0, 7}}}) {
    const std::vector<bool> near = at_input_angles(square(lines));
    EXPECT_EQ(std::count(near.begin(), near.end(), true), 0);
  }
}

TEST(InputAngles, AllElementsAtTheVertexOfANarrowSectorAreNear) {
  // Lines along 0° and 45°, and such a line that ends at a side of the square.
  const std::vector<bool> middle = at_input_angles(square({{0, 1}, {0, 2}}));
  EXPECT_EQ(std::count(middle.begin(), middle.end(), true), 8);
  // A diagonal cuts the right angle of a corner in two; the triangles at that corner are near.
  const std::vector<bool> corner = at_input_angles(square({{0, 2}}));
  EXPECT_EQ(corner, std::vector<bool>({true, true, false, false, false, false, false, false}));
}

TEST(InputAngles, TurningBackIsNotNarrow) {
  // Two lines 45° apart in a mesh without what is between them: the sector is the other 315°.
  ElementTable whole = square({});
  const ElementTable notched =
      plane_table(whole.points, {whole.corners.begin() + 1, whole.corners.end()}, {});
  const std::vector<bool> near = at_input_angles(notched);
  // The half-angle of 45° at the corner (1, 1) is narrow, the notch is not.
  EXPECT_EQ(near, std::vector<bool>({true, false, false, false, false, false, false}));
}

TEST(AreaQuality, SharesOfAreaAwayFromInputAngles) {
  // A square cut from a point near its lower side: a thin triangle and three with good angles.
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.005, 0}};
  const ElementTable table = plane_table(points, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, {});
  const AreaQuality quality = summarize_area_quality(table);
  const double thin = std::atan(0.01) * 180 / M_PI;
  EXPECT_EQ(quality.near_input_angles, 0);
  EXPECT_NEAR(quality.min_angle, thin, 1e-12);
  EXPECT_NEAR(quality.tolerable, 1 - 0.0025, 1e-12);
  EXPECT_NEAR(quality.histogram[0], 0.0025, 1e-12);
  double sum = 0;
  for (const double share : quality.histogram) sum += share;
  EXPECT_NEAR(sum, 1, 1e-12);
  // The smallest angle of the other three is atan(0.5 / 0.995), 26.7°.
  EXPECT_NEAR(quality.good, 1 - 0.0025, 1e-12);
}

TEST(AreaQuality, ExemptElementsDoNotCount) {
  const ElementTable needle = plane_table({{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}}, {{0, 1, 2}}, {});
  const AreaQuality quality = summarize_area_quality(needle);
  EXPECT_EQ(quality.near_input_angles, 1);
  EXPECT_EQ(quality.good, 1);
  EXPECT_EQ(quality.tolerable, 1);
  EXPECT_EQ(quality.histogram[0], 1);
  EXPECT_EQ(summarize_area_quality({}).near_input_angles, 0);
}

}  // namespace
}  // namespace halfshade
