#include "meshing/arrangement/snap_graph.h"

#include "meshing/core/planar.h"
#include "meshing/geometry/planar_signs.h"
#include "tests/support/curve_families.h"

#include <gtest/gtest.h>

#include <set>

namespace halfshade::test {
namespace {

constexpr double snap = 1e-7;

struct Present {
  std::vector<Segment2> edges;
  std::vector<std::array<int, 2>> ends;
  std::set<int> points;
};

Present present(const SnapGraph& graph) {
  Present result;
  for (const auto& e : graph.edges()) {
    if (e.part_count > 0) continue;
    result.ends.push_back({e.a, e.b});
    result.edges.push_back({graph.points()[static_cast<std::size_t>(e.a)],
                            graph.points()[static_cast<std::size_t>(e.b)]});
    result.points.insert({e.a, e.b});
  }
  return result;
}

std::set<std::array<double, 4>> places(const SnapGraph& graph) {
  std::set<std::array<double, 4>> result;
  for (const auto& [a, b] : present(graph).edges) {
    const std::array<double, 2> p = {a.x(), a.y()}, q = {b.x(), b.y()};
    const auto& [first, last] = std::minmax(p, q);
    result.insert({first[0], first[1], last[0], last[1]});
  }
  return result;
}

std::vector<int> add(SnapGraph& graph, const std::vector<CurvePolyline>& lines) {
  std::vector<int> edges;
  for (const CurvePolyline& line : lines)
    for (std::size_t k = 1; k < line.points.size(); ++k)
      edges.push_back(graph.add_line(line.points[k - 1], line.points[k]));
  return edges;
}

int add_square(SnapGraph& graph) {
  const std::array<int, 4> p = {graph.add_fixed_point({0, 0}), graph.add_fixed_point({1, 0}),
                                graph.add_fixed_point({1, 1}), graph.add_fixed_point({0, 1})};
  for (std::size_t k = 0; k < 4; ++k) graph.add_fixed_edge(p[k], p[(k + 1) % 4]);
  return p[0];
}

bool cross(const Segment2& e, const Segment2& f) {
  return orientation(e[0], e[1], f[0]) * orientation(e[0], e[1], f[1]) < 0 &&
         orientation(f[0], f[1], e[0]) * orientation(f[0], f[1], e[1]) < 0;
}

class SnapGraphFamily : public testing::TestWithParam<std::tuple<const char*, unsigned>> {
 protected:
  std::vector<CurvePolyline> lines(int n) const {
    return LineFamily(std::get<0>(GetParam()), std::get<1>(GetParam())).make(n);
  }
};

TEST_P(SnapGraphFamily, NothingCrosses) {
  SnapGraph graph(snap);
  add_square(graph);
  add(graph, lines(40));
  ASSERT_TRUE(graph.settle());
  const Present p = present(graph);
  for (std::size_t i = 0; i < p.edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(cross(p.edges[i], p.edges[j]));
}

TEST_P(SnapGraphFamily, MinimumSeparationOfPointsAndEdges) {
  SnapGraph graph(snap);
  add_square(graph);
  add(graph, lines(40));
  ASSERT_TRUE(graph.settle());
  const Present p = present(graph);
  for (const int i : p.points)
    for (const int j : p.points)
      if (i < j) {
        EXPECT_GE((graph.points()[static_cast<std::size_t>(i)] -
                   graph.points()[static_cast<std::size_t>(j)])
                      .norm(),
                  0.499 * snap);
      }
  for (std::size_t e = 0; e < p.edges.size(); ++e)
    for (const int i : p.points)
      if (i != p.ends[e][0] && i != p.ends[e][1]) {
        EXPECT_GE(distance_to_segment(graph.points()[static_cast<std::size_t>(i)], p.edges[e][0],
                                      p.edges[e][1]),
                  snap / 3);
      }
}

TEST_P(SnapGraphFamily, EveryLineIsAChainCloseToIt) {
  SnapGraph graph(snap);
  const auto given = lines(40);
  std::vector<Segment2> segments;
  for (const CurvePolyline& line : given)
    for (std::size_t k = 1; k < line.points.size(); ++k)
      segments.push_back({line.points[k - 1], line.points[k]});
  add_square(graph);
  const std::vector<int> edges = add(graph, given);
  ASSERT_TRUE(graph.settle());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (edges[s] < 0) {
      EXPECT_LE((segments[s][1] - segments[s][0]).norm(), 3 * snap);
      continue;
    }
    std::map<int, int> degree;
    graph.for_each_part(edges[s], [&](int part) {
      const auto& e = graph.edges()[static_cast<std::size_t>(part)];
      for (const int end : {e.a, e.b}) {
        ++degree[end];
        const Vec2& p = graph.points()[static_cast<std::size_t>(end)];
        EXPECT_LE(distance_to_segment(p, segments[s][0], segments[s][1]), 6 * snap);
      }
    });
    int odd = 0;
    for (const auto& [point, count] : degree) odd += count % 2;
    EXPECT_EQ(odd, 2) << "a chain has two ends";
  }
}

TEST_P(SnapGraphFamily, SettledGraphsStayAsTheyAre) {
  SnapGraph first(snap), second(snap);
  add(first, lines(40));
  ASSERT_TRUE(first.settle());
  for (const auto& [a, b] : present(first).edges) second.add_line(a, b);
  ASSERT_TRUE(second.settle());
  EXPECT_EQ(places(first), places(second));
}

INSTANTIATE_TEST_SUITE_P(Families, SnapGraphFamily,
                         testing::Combine(testing::Values("Random", "Concurrent", "NearParallel",
                                                          "AxisAligned", "ConicTangent", "Fan",
                                                          "Offset", "Coincident", "AlongTheBorder"),
                                          testing::Values(1U, 2U)),
                         [](const auto& name) {
                           return std::get<0>(name.param) + std::to_string(std::get<1>(name.param));
                         });

TEST(SnapGraph, LinesThatMissAPointByLittleRunThroughIt) {
  SnapGraph graph(snap);
  const int corner = add_square(graph);
  const int line = graph.add_line({-0.5, 0.5 + 0.3 * snap}, {0.5, -0.5 + 0.3 * snap});
  ASSERT_TRUE(graph.settle());
  std::set<int> points;
  graph.for_each_part(line, [&](int part) {
    points.insert(graph.edges()[static_cast<std::size_t>(part)].a);
    points.insert(graph.edges()[static_cast<std::size_t>(part)].b);
  });
  EXPECT_TRUE(points.contains(corner));
  EXPECT_EQ(points.size(), 3U);
}

TEST(SnapGraph, EndsNearFixedEdgesLieOnThem) {
  SnapGraph graph(snap);
  add_square(graph);
  graph.add_line({0.3, 0.4 * snap}, {0.7, 1 - 0.4 * snap});
  ASSERT_TRUE(graph.settle());
  std::set<double> heights;
  for (const int p : present(graph).points)
    heights.insert(graph.points()[static_cast<std::size_t>(p)].y());
  EXPECT_EQ(heights, (std::set<double>{0, 1}));
}

TEST(SnapGraph, FixedPointsAndEdgesAreNeverMovedNorMerged) {
  SnapGraph graph(snap);
  // Much closer together than the snap distance, with lines in between.
  const int a = graph.add_fixed_point({0, 0}), b = graph.add_fixed_point({1, 0});
  const int c = graph.add_fixed_point({1, 1e-10}), d = graph.add_fixed_point({0, 1e-10});
  const int low = graph.add_fixed_edge(a, b), high = graph.add_fixed_edge(c, d);
  graph.add_line({0.2, -1}, {0.2, 1});
  graph.add_line({0.1, 0.3e-10}, {0.9, 0.6e-10});
  ASSERT_TRUE(graph.settle());
  std::set<int> low_parts, high_parts;
  graph.for_each_part(low, [&](int part) { low_parts.insert(part); });
  graph.for_each_part(high, [&](int part) { high_parts.insert(part); });
  for (const int part : low_parts) {
    EXPECT_FALSE(high_parts.contains(part));
    const auto& e = graph.edges()[static_cast<std::size_t>(part)];
    EXPECT_EQ(graph.points()[static_cast<std::size_t>(e.a)].y(), 0);
    EXPECT_EQ(graph.points()[static_cast<std::size_t>(e.b)].y(), 0);
  }
}

TEST(SnapGraph, FrozenLinesStayWhereTheyAre) {
  SnapGraph graph(snap);
  add_square(graph);
  const int contact = graph.add_line({0.1, 0.5}, {0.9, 0.5}, 1e-13);
  ASSERT_TRUE(graph.settle());
  graph.freeze();
  graph.add_line({0.2, 0.5 + 0.3 * snap}, {0.6, 0.5 - 0.3 * snap});
  graph.add_line({0.5, 0}, {0.5, 1});
  ASSERT_TRUE(graph.settle());
  int parts = 0;
  graph.for_each_part(contact, [&](int part) {
    const auto& e = graph.edges()[static_cast<std::size_t>(part)];
    EXPECT_TRUE(e.is_fixed);
    EXPECT_EQ(graph.points()[static_cast<std::size_t>(e.a)].y(), 0.5);
    EXPECT_EQ(graph.points()[static_cast<std::size_t>(e.b)].y(), 0.5);
    ++parts;
  });
  EXPECT_EQ(parts, 4);
}

TEST(SnapGraph, ManyCoincidentLinesShareTheirEdges) {
  SnapGraph graph(snap);
  std::vector<int> lines;
  for (int i = 0; i < 300; ++i)
    lines.push_back(graph.add_line({0.001 * i, 1e-9 * (i % 10)}, {1 + 0.001 * i, 0}));
  ASSERT_TRUE(graph.settle());
  // All ends lie on one line: 600 points at most, since the last 300 are not those of the first.
  EXPECT_EQ(present(graph).points.size(), 600U);
  EXPECT_EQ(present(graph).edges.size(), 599U);
}

}  // namespace
}  // namespace halfshade::test
