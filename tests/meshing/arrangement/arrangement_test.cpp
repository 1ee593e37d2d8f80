#include "meshing/arrangement/arrangement.h"

#include "meshing/arrangement/overlay.h"
#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/corner_fans.h"
#include "meshing/patches/face_lookup.h"
#include "meshing/repair/planes.h"
#include "tests/support/expect_error.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace halfshade {
namespace {

using Link = std::array<int, 2>;

std::vector<Link> links_of(const Arrangement& arrangement) {
  std::vector<Link> links;
  for (const auto& chain : arrangement.chains)
    for (std::size_t k = 1; k < chain.size(); ++k)
      links.push_back({std::min(chain[k - 1], chain[k]), std::max(chain[k - 1], chain[k])});
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

// By comparing all pairs.
void expect_arranged(const Arrangement& arrangement, double snap) {
  const std::vector<Link> links = links_of(arrangement);
  const auto at = [&](int p) { return arrangement.points[static_cast<std::size_t>(p)]; };
  for (const auto& [a, b] : links)
    for (const auto& [c, d] : links) {
      if (a == c || a == d || b == c || b == d) continue;
      EXPECT_GT(distance_to_segment(at(c), at(a), at(b)), 0.7 * snap);
      // Parts of one line are told from crossings by their boxes, not by signs of zero.
      if ((at(a).cwiseMin(at(b)).array() > at(c).cwiseMax(at(d)).array()).any()) continue;
      if ((at(c).cwiseMin(at(d)).array() > at(a).cwiseMax(at(b)).array()).any()) continue;
      const bool c_left = cross_2d(at(b) - at(a), at(c) - at(a)) > 0;
      const bool d_left = cross_2d(at(b) - at(a), at(d) - at(a)) > 0;
      const bool a_left = cross_2d(at(d) - at(c), at(a) - at(c)) > 0;
      const bool b_left = cross_2d(at(d) - at(c), at(b) - at(c)) > 0;
      EXPECT_FALSE(c_left != d_left && a_left != b_left) << "links cross";
    }
}

TEST(Arrange, LeavesSegmentsThatDoNotMeetAlone) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  const Arrangement result = arrange(points, std::vector<Link>{{0, 1}, {3, 2}}, {1e-9, 1e-9});
  EXPECT_EQ(result.points, points);
  EXPECT_EQ(result.chains, (std::vector<std::vector<int>>{{0, 1}, {3, 2}}));
}

TEST(Arrange, SplitsAtCrossingsPointsAndOverlaps) {
  // A cross, a point on its horizontal bar and a segment along that bar.
  const std::vector<Vec2> points = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {0.5, 1e-10}, {0.75, 2}};
  const Arrangement result =
      arrange(points, std::vector<Link>{{0, 1}, {2, 3}, {4, 5}, {4, 0}}, {1e-9, 1e-9});
  ASSERT_EQ(result.points.size(), 7u);
  EXPECT_LT(result.points[6].norm(), 1e-9);
  EXPECT_EQ(result.chains,
            (std::vector<std::vector<int>>{{0, 6, 4, 1}, {2, 6, 3}, {4, 5}, {4, 6, 0}}));
}

TEST(Arrange, ClosePointsBecomeTheFirstOfThem) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {1 + 1e-10, 1e-10}, {1, 1}, {0, 1e-10}};
  const Arrangement result =
      arrange(points, std::vector<Link>{{0, 1}, {2, 3}, {0, 4}}, {1e-9, 1e-9});
  EXPECT_EQ(result.chains, (std::vector<std::vector<int>>{{0, 1}, {1, 3}, {0}}));
}

TEST(Arrange, RandomSegmentsMeetInCommonPointsOnly) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double snap : {1e-9, 1e-6, 1e-3}) {
    std::vector<Vec2> points;
    std::vector<Link> segments;
    for (int k = 0; k < 60; ++k) {
      points.emplace_back(uniform(random), uniform(random));
      points.emplace_back(uniform(random), uniform(random));
      segments.push_back({2 * k, 2 * k + 1});
    }
    const Arrangement result = arrange(points, segments, {snap, snap});
    expect_arranged(result, snap);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      EXPECT_EQ(result.chains[s].front(), segments[s][0]);
      EXPECT_EQ(result.chains[s].back(), segments[s][1]);
      const Segment2 segment = {points[2 * s], points[2 * s + 1]};
      for (const int p : result.chains[s])
        EXPECT_LT(
            distance_to_segment(result.points[static_cast<std::size_t>(p)], segment[0], segment[1]),
            4 * snap);
    }
  }
}

TEST(ConstrainedDelaunay, CoversTheHullAndKeepsLinks) {
  const std::vector<Vec2> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {9, 9}};
  const std::vector<Link> links = {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 4}};
  const HullTriangulation hull = constrained_delaunay(points, links);  // point 5 has no link
  EXPECT_EQ(hull.triangles.size(), 4u);
  double area = 0;
  for (const auto& t : hull.triangles) area += 0.5 * twice_area(points, t);
  EXPECT_DOUBLE_EQ(area, 4);
  EXPECT_EQ(hull.neighbours, edge_neighbours(hull.triangles));
}

TEST(ConstrainedDelaunay, PointsOnOneCircleDoNotHangOnRounding) {
  // Regular polygons, and rows of rectangles: whatever they are multiplied by.
  std::vector<std::vector<Vec2>> outlines;
  for (const int n : {4, 5, 6, 12, 30}) {
    auto& ring = outlines.emplace_back();
    for (int k = 0; k < n; ++k)
      ring.emplace_back(0.3 + 0.7 * std::cos(2 * M_PI * k / n),
                        0.1 + 0.7 * std::sin(2 * M_PI * k / n));
  }
  outlines.push_back({{0, 0}, {.1, 0}, {.2, 0}, {.3, 0}, {.3, .7}, {.2, .7}, {.1, .7}, {0, .7}});
  for (const std::vector<Vec2>& ring : outlines) {
    std::vector<Link> links;
    for (int k = 0; k < static_cast<int>(ring.size()); ++k)
      links.push_back({k, (k + 1) % static_cast<int>(ring.size())});
    const HullTriangulation expected = constrained_delaunay(ring, links);
    EXPECT_EQ(expected.triangles.size(), ring.size() - 2);
    for (const double factor : {3., 1e-3, 0.7, 1e9, 1e-30}) {
      std::vector<Vec2> scaled = ring;
      for (Vec2& p : scaled) p *= factor;
      const HullTriangulation hull = constrained_delaunay(scaled, links);
      EXPECT_EQ(hull.triangles, expected.triangles) << factor;
      EXPECT_EQ(hull.neighbours, edge_neighbours(hull.triangles));
      for (const auto& t : hull.triangles) EXPECT_GT(twice_area(scaled, t), 0);
    }
  }
}

TEST(ConstrainedDelaunay, CrossingLinksAreAnError) {
  const std::vector<Vec2> points = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  test::expect_error(
      [&] {
        constrained_delaunay(points, std::vector<Link>{{0, 1}, {2, 3}});
      },
      ErrorCode::invalid_input, {"could not be triangulated"});
}

TEST(Overlay, CountsWindings) {
  // Two overlapping squares and a bow tie.
  const std::vector<Vec2> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {3, 1},
                                    {3, 3}, {1, 3}, {5, 0}, {6, 1}, {6, 0}, {5, 1}};
  const std::vector<std::vector<int>> loops = {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}};
  const Overlay result = overlay(points, loops, {1e-9, 1e-9});
  std::map<std::vector<std::pair<int, int>>, double> area;
  for (std::size_t t = 0; t < result.winding.size(); ++t)
    area[result.winding[t]] += 0.5 * twice_area(result.points, result.hull.triangles[t]);
  area.erase(std::vector<std::pair<int, int>>());
  const decltype(area) expected = {
      {{{0, 1}}, 3}, {{{0, 1}, {1, 1}}, 1}, {{{1, 1}}, 3}, {{{2, 1}}, 0.25}, {{{2, -1}}, 0.25}};
  ASSERT_EQ(area.size(), expected.size());
  for (const auto& [winding, size] : expected) EXPECT_NEAR(area[winding], size, 1e-12);
  EXPECT_EQ(crossed_loops(result, 1e-9), (std::vector<int>{2}));
}

TEST(CornerFans, SeparateWhereTrianglesMeetInAPointOnly) {
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {2, 1, 3}, {2, 4, 5}};
  const CornerFans fans = corner_fans(triangles, edge_neighbours(triangles));
  EXPECT_EQ(fans.count, 7);
  EXPECT_EQ(fans.of_corner[0][2], fans.of_corner[1][0]);
  EXPECT_NE(fans.of_corner[0][2], fans.of_corner[2][0]);
}

TEST(CornerFans, StayTogetherRoundTheEndOfAWall) {
  // A full fan of four triangles round point 0 with one wall: both its sides meet behind it.
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  auto neighbours = edge_neighbours(triangles);
  neighbours[0][0] = neighbours[3][2] = -1;  // the edge from 0 to 1
  const CornerFans fans = corner_fans(triangles, neighbours);
  EXPECT_EQ(fans.count, 6);  // point 1 twice
  for (std::size_t t = 1; t < 4; ++t) EXPECT_EQ(fans.of_corner[t][0], fans.of_corner[0][0]);
  neighbours[1][2] = neighbours[2][0] = -1;  // and the one from 0 to 3: the wall goes through
  EXPECT_EQ(corner_fans(triangles, neighbours).count, 8);
}

TEST(FaceLookup, FindsTheFaceThatHoldsThePointElseTheNearest) {
  Surface surface;
  surface.faces = {7, 3, 9};
  surface.face_rings = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                        {{1, 0}, {2, 0}, {2, 1}, {1, 1}},
                        {{0.5, 0}, {3, 0}, {3, 1}}};
  const FaceLookup lookup(surface);
  EXPECT_EQ(lookup.face_at({0.5, 0.5}), 7);
  EXPECT_EQ(lookup.face_at({1.5, 0.1}), 3);  // the third holds it, too
  EXPECT_EQ(lookup.face_at({2.9, 0.5}), 9);
  EXPECT_EQ(lookup.face_at({-0.1, 0.5}), 7);
}

TEST(Arrange, PointsNearerThanLinksSnapDoNotMakeChainsGrowWithoutEnd) {
  test::Random random(3);
  std::vector<Vec2> points;
  std::vector<std::array<int, 2>> segments;
  for (int k = 0; k < 40; ++k) {
    points.emplace_back(random(-1e-3, 1e-3), random(-1e-3, 1e-3));
    points.emplace_back(random(-1e-3, 1e-3) + (k % 2), random(-1e-3, 1e-3));
    segments.push_back({2 * k, 2 * k + 1});
  }
  const Arrangement result = arrange(points, segments, {1e-6, 1e-3});
  ASSERT_EQ(result.chains.size(), segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    std::vector<int> chain = result.chains[s];
    EXPECT_EQ(chain.front(), segments[s][0]);
    EXPECT_EQ(chain.back(), segments[s][1]);
    std::sort(chain.begin(), chain.end());
    EXPECT_EQ(std::adjacent_find(chain.begin(), chain.end()), chain.end());
  }
}

/// Two quadrilaterals side by side, along sides whose ends are a thousandth of the links' radius
/// apart: each was led through the ends of the other one, turned back there and was itself again.
/// They crossed in the end, which no triangulation takes.
TEST(Overlay, TakesSidesThatLeadThroughEachOthersEnds) {
  const std::vector<Vec2> points = {{-4.398938, -75.646759}, {-4.398937, -74.032715},
                                    {2.483863, -74.032715},  {2.483863, -75.646759},
                                    {-5.561995, -79.301674}, {-5.561996, -70.3778},
                                    {-4.398938, -74.032715}, {-4.398937, -75.646759}};
  const std::vector<std::vector<int>> loops = {{0, 3, 2, 1}, {4, 7, 6, 5}};
  const Overlay result = overlay(points, loops, {5e-7, 5e-4});
  double area = 0;
  for (std::size_t t = 0; t < result.hull.triangles.size(); ++t) {
    if (result.winding[t].empty()) continue;
    EXPECT_EQ(result.winding[t].size(), 1u) << "no place is in both";
    EXPECT_EQ(result.winding[t].front().second, 1);
    area += twice_area(result.points, result.hull.triangles[t]) / 2;
  }
  EXPECT_NEAR(area, (twice_area(points, loops[0]) + twice_area(points, loops[1])) / 2, 1e-5);
}

}  // namespace
}  // namespace halfshade
