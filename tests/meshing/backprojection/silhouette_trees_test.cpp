#include "meshing/backprojection/silhouette_trees.h"

#include "tests/support/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// A closed sphere and a sheet with a border.
OpaqueTopology sphere_and_sheet() {
  SoundScene scene;
  test::add_sphere(scene, {0, 0, 1}, .3, 2);
  test::add_lit_surface(scene, test::facing_down(-.5, .5, -.5, .5, 2), 1);
  test::finish(scene);
  return make_opaque_topology(scene);
}

TEST(SilhouetteTrees, HoldEveryEdgeOnceInTheOneOrTheOther) {
  const OpaqueTopology topology = sphere_and_sheet();
  const SilhouetteTrees trees = make_silhouette_trees(topology);
  std::vector<int> closed(topology.edges.size(), 0), open(topology.edges.size(), 0);
  for (const int e : trees.closed_edges.items) ++closed[at(e)];
  for (const int e : trees.open_edges.items) ++open[at(e)];
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    EXPECT_EQ(closed[e] + open[e], 1);
    EXPECT_EQ(closed[e], topology.edges[e].count == 2);
  }
  EXPECT_EQ(trees.open_edges.items.size(), 4u);
}

TEST(SilhouetteTrees, ConesHoldTheNormalsAndVerticesBelowThem) {
  const OpaqueTopology topology = sphere_and_sheet();
  const SilhouetteTrees trees = make_silhouette_trees(topology);
  ASSERT_EQ(trees.cones.size(), trees.closed_edges.nodes.size());
  int known = 0;
  for (std::size_t n = 0; n < trees.cones.size(); ++n) {
    const NormalCone& cone = trees.cones[n];
    if (cone.axis.isZero()) continue;
    ++known;
    const FlatTree::Node& node = trees.closed_edges.nodes[n];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const OpaqueTopology::Edge& edge = topology.edges[at(trees.closed_edges.items[at(i)])];
      for (const Vec3& p : topology.ends(edge)) {
        EXPECT_LE((p - cone.centre).norm(), cone.radius);
        EXPECT_LE(std::abs(cone.axis.dot(p - cone.centre)), cone.thickness);
      }
      for (int k = edge.first; k < edge.first + edge.count; ++k) {
        const auto& corner = topology.triangles[at(topology.incidences[at(k)].triangle)].corner;
        const Vec3& a = topology.vertices[at(corner[0])];
        const Vec3 normal = (topology.vertices[at(corner[1])] - a)
                                .cross(topology.vertices[at(corner[2])] - a)
                                .normalized();
        EXPECT_GE(std::abs(cone.axis.dot(normal)), cone.cosine - 1e-12);
      }
    }
  }
  EXPECT_GT(known, 10);
  EXPECT_TRUE(trees.cones[0].axis.isZero()) << "a sphere looks all ways";
}

}  // namespace
}  // namespace halfshade
