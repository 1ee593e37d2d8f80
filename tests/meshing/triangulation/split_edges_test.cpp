#include "meshing/triangulation/split_edges.h"

#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>

#include <random>

namespace halfshade {
namespace {

using test::expect_sound;

const Ring square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Ring hole = {{0.3, 0.3}, {0.3, 0.6}, {0.6, 0.6}, {0.6, 0.3}};

std::vector<EdgePoints> every_third_constrained_edge(const PlanarMesh& mesh) {
  std::vector<EdgePoints> result;
  for (std::size_t i = 0; i < mesh.constrained_edges.size(); i += 3) {
    const auto& edge = mesh.constrained_edges[i];
    const Vec2 a = mesh.points[static_cast<std::size_t>(edge[0])];
    const Vec2 b = mesh.points[static_cast<std::size_t>(edge[1])];
    result.push_back({edge, {0.75 * a + 0.25 * b}});
    if (i % 2 == 0) result.back().points.push_back(0.25 * a + 0.75 * b);
  }
  return result;
}

std::size_t count_points(const std::vector<EdgePoints>& edges) {
  std::size_t count = 0;
  for (const EdgePoints& edge : edges) count += edge.points.size();
  return count;
}

TEST(SplitEdges, BordersOfCoarseAndFineMeshes) {
  for (const double length : {0., 0.2, 0.05}) {
    PlanarMesh mesh =
        refine_triangulation(std::vector<Ring>{square, hole}, {}, {.max_length = length});
    const std::size_t triangles = mesh.triangles.size();
    const auto edges = every_third_constrained_edge(mesh);
    split_edges(mesh, edges);
    expect_sound(mesh, {square, hole});
    EXPECT_EQ(mesh.triangles.size(), triangles + count_points(edges));
  }
}

TEST(SplitEdges, ContactLinesSplitTheTrianglesOnBothSides) {
  const std::vector<Segment2> contacts = {{Vec2(0.1, 0.1), Vec2(0.9, 0.1)},
                                          {Vec2(0.5, 0.7), Vec2(0.5, 0.9)}};
  PlanarMesh mesh = triangulate(std::vector<Ring>{square}, contacts);
  const std::size_t triangles = mesh.triangles.size();
  std::vector<EdgePoints> edges;
  for (const auto& edge : mesh.constrained_edges) {
    const Vec2 a = mesh.points[static_cast<std::size_t>(edge[0])];
    const Vec2 b = mesh.points[static_cast<std::size_t>(edge[1])];
    const bool inner = std::min(a.x(), b.x()) > 0.05 && std::max(a.x(), b.x()) < 0.95;
    if (inner) edges.push_back({edge, {0.5 * (a + b), 0.25 * a + 0.75 * b}});
  }
  ASSERT_EQ(edges.size(), 2u);
  split_edges(mesh, edges);
  expect_sound(mesh, {square}, contacts);
  EXPECT_EQ(mesh.triangles.size(), triangles + 8);
}

TEST(SplitAndRefine, KeepsPointsAndRestoresQuality) {
  const PlanarMeshOptions options{.max_length = 0.1};
  PlanarMesh mesh = refine_triangulation(std::vector<Ring>{square, hole}, {}, options);
  const std::vector<Vec2> before = mesh.points;
  const auto edges = every_third_constrained_edge(mesh);
  split_and_refine(mesh, edges, options);
  expect_sound(mesh, {square, hole});
  EXPECT_TRUE(mesh.complete);
  EXPECT_EQ(std::vector<Vec2>(mesh.points.begin(),
                              mesh.points.begin() + static_cast<std::ptrdiff_t>(before.size())),
            before);
  for (const EdgePoints& edge : edges)
    for (const Vec2& p : edge.points)
      EXPECT_EQ(std::count(mesh.points.begin(), mesh.points.end(), p), 1);
  const auto [angle, length] = test::angle_and_length(mesh);
  EXPECT_GE(angle, 20.7);
  EXPECT_LE(length, 0.1);
}

TEST(SplitAndRefine, NothingToSplitChangesNothing) {
  PlanarMesh mesh = refine_triangulation(std::vector<Ring>{square}, {}, {.max_length = 0.2});
  const std::size_t points = mesh.points.size();
  split_and_refine(mesh, {}, {.max_length = 0.2});
  EXPECT_EQ(mesh.points.size(), points);
}

}  // namespace
}  // namespace halfshade
