#include "meshing/backprojection/opaque_topology.h"

#include "tests/support/surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace halfshade {
namespace {

using test::facing_down;

TEST(OpaqueTopology, JoinsCornersAndSplitsEdgesAtTJunctions) {
  SoundScene scene;
  test::add_lit_surface(scene, facing_down(0, 2, 0, 1, 1), 1);
  test::add_lit_surface(scene, facing_down(0, 1, 1, 2, 1));
  test::add_lit_surface(scene, facing_down(1, 2, 1, 2, 1));
  test::finish(scene);
  const OpaqueTopology topology = make_opaque_topology(scene);
  EXPECT_EQ(topology.vertices.size(), 8u);
  EXPECT_EQ(topology.ring(0).size(), 5u);  // with the corner (1, 1)
  EXPECT_EQ(topology.triangles.size(), 7u);
  int borders = 0;
  for (const auto& edge : topology.edges) borders += edge.count == 1 ? 1 : 0;
  EXPECT_EQ(borders, 7);
  // Euler's formula for a disk: vertices − edges + faces = 1.
  EXPECT_EQ(topology.vertices.size() + topology.triangles.size(), topology.edges.size() + 1);
}

TEST(OpaqueTopology, KnowsTheTrianglesAtEveryEdge) {
  const OpaqueTopology topology = make_opaque_topology(test::square_over_square());
  for (const OpaqueTopology::Edge& edge : topology.edges) {
    EXPECT_LT(edge.from, edge.to);
    EXPECT_GT(edge.count, 0);
    for (int i = edge.first; i < edge.first + edge.count; ++i) {
      const auto& [triangle, direction] = topology.incidences[at(i)];
      const auto& corner = topology.triangles[at(triangle)].corner;
      int found = 0;
      for (std::size_t k = 0; k < 3; ++k)
        found += corner[k] == (direction > 0 ? edge.from : edge.to) &&
                 corner[(k + 1) % 3] == (direction > 0 ? edge.to : edge.from);
      EXPECT_EQ(found, 1);
    }
  }
  for (const OpaqueTopology::Triangle& triangle : topology.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const OpaqueTopology::Edge& edge = topology.edges[at(triangle.edge[k])];
      EXPECT_EQ(std::minmax(edge.from, edge.to),
                std::minmax(triangle.corner[k], triangle.corner[(k + 1) % 3]));
    }
}

}  // namespace
}  // namespace halfshade
