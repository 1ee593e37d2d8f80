#include "tests/support/curve_invariants.h"

#include "meshing/core/planar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace halfshade::test {

void expect_sound(const CurveMesh& curved, const std::vector<Ring>& rings,
                  const std::vector<Segment2>& contacts) {
  const auto& edges = curved.mesh.constrained_edges;
  ASSERT_EQ(curved.is_d0.size(), edges.size());
  ASSERT_EQ(curved.curve_begin.size(), edges.size() + 1);
  ASSERT_EQ(curved.curve_begin.front(), 0);
  ASSERT_EQ(curved.curve_begin.back(), static_cast<int>(curved.curves.size()));
  std::set<std::array<int, 2>> sides;
  for (const auto& t : curved.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sides.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  PlanarMesh with_d0_only = curved.mesh;
  with_d0_only.constrained_edges.clear();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    EXPECT_TRUE(sides.contains(edges[e]));
    const auto first = curved.curves.begin() + curved.curve_begin[e];
    const auto last = curved.curves.begin() + curved.curve_begin[e + 1];
    ASSERT_LE(first, last);
    EXPECT_TRUE(curved.is_d0[e] || first != last) << "a line that nobody asked for";
    EXPECT_TRUE(std::adjacent_find(first, last, std::greater_equal<>()) == last);
    if (curved.is_d0[e]) with_d0_only.constrained_edges.push_back(edges[e]);
  }
  EXPECT_TRUE(std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) ==
              edges.end());
  expect_sound(with_d0_only, rings, contacts);
  std::set<std::array<double, 2>> places;
  for (const Vec2& p : curved.mesh.points) places.insert({p.x(), p.y()});
  for (const Ring& ring : rings)
    for (const Vec2& p : ring) EXPECT_TRUE(places.contains({p.x(), p.y()})) << "ring vertex lost";
}

void expect_follows(const CurveMesh& curved, const std::vector<Ring>& rings,
                    const std::vector<CurvePolyline>& lines, double snap) {
  EXPECT_LE(curved.deviation, 6 * snap);
  double rounding = 0;  // of midpoints
  for (const Vec2& p : curved.mesh.points) rounding = std::max(rounding, p.cwiseAbs().maxCoeff());
  const double slack = curved.deviation + 1e-12 + 0x1p-51 * rounding;
  std::vector<std::vector<Segment2>> edges_of(lines.size());
  for (std::size_t e = 0; e < curved.is_d0.size(); ++e)
    for (int i = curved.curve_begin[e]; i < curved.curve_begin[e + 1]; ++i)
      edges_of[static_cast<std::size_t>(curved.curves[static_cast<std::size_t>(i)])].push_back(
          place_of(curved.mesh, curved.mesh.constrained_edges[e]));
  for (const CurvePolyline& line : lines) {
    const auto& edges = edges_of[static_cast<std::size_t>(line.id)];
    const auto distance_to_line = [&](const Vec2& p) {
      double least = HUGE_VAL;
      for (std::size_t k = 1; k < line.points.size(); ++k)
        least = std::min(least, distance_to_segment(p, line.points[k - 1], line.points[k]));
      return least;
    };
    for (const Segment2& edge : edges)
      for (const Vec2& p : {edge[0], edge[1], Vec2(0.5 * (edge[0] + edge[1]))})
        EXPECT_LE(distance_to_line(p), slack) << "line " << line.id;
    for (std::size_t k = 1; k < line.points.size(); ++k)
      for (int i = 0; i <= 20; ++i) {
        const Vec2 p = line.points[k - 1] + i / 20.0 * (line.points[k] - line.points[k - 1]);
        const double length = (line.points[k] - line.points[k - 1]).norm();
        if (length < 4 * snap || !is_inside(rings, p) || distance_to_rings(rings, p) < 8 * snap)
          continue;
        double least = HUGE_VAL;
        for (const Segment2& edge : edges)
          least = std::min(least, distance_to_segment(p, edge[0], edge[1]));
        EXPECT_LE(least, 6 * snap) << "a gap in line " << line.id;
      }
  }
}

int region_count(const CurveMesh& curved) {
  std::map<std::array<int, 2>, int> beside;
  std::vector<int> parent;
  const auto root = [&](int t) {
    while (parent[static_cast<std::size_t>(t)] != t) t = parent[static_cast<std::size_t>(t)];
    return t;
  };
  const auto& walls = curved.mesh.constrained_edges;
  int count = 0;
  for (const auto& triangle : curved.mesh.triangles) {
    const int t = static_cast<int>(parent.size());
    parent.push_back(t);
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      if (std::binary_search(walls.begin(), walls.end(), std::array<int, 2>{a, b})) continue;
      const auto [entry, is_first] = beside.try_emplace({a, b}, t);
      if (is_first || root(entry->second) == root(t)) continue;
      parent[static_cast<std::size_t>(root(t))] = root(entry->second);
      --count;
    }
  }
  return count;
}

}  // namespace halfshade::test
