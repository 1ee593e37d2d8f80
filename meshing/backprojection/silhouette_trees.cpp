#include "meshing/backprojection/silhouette_trees.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace halfshade {
namespace {

Bounds box_of(const OpaqueTopology& topology, const OpaqueTopology::Edge& edge) {
  const auto [from, to] = topology.ends(edge);
  return bounds_of(from, to);
}

/// The two faces at an edge that has just two.
struct Pair {
  OpaqueTopology::Incidence a, b;
};
Pair faces_at(const OpaqueTopology& topology, const OpaqueTopology::Edge& edge) {
  return {topology.incidences[at(edge.first)], topology.incidences[at(edge.first) + 1]};
}

/// ±1 for each triangle, so that neighbours look the same way where that can be.
std::vector<int> align(const OpaqueTopology& topology) {
  std::vector<int> sense(topology.triangles.size(), 0), open;
  for (std::size_t seed = 0; seed < sense.size(); ++seed) {
    if (sense[seed] != 0) continue;
    sense[seed] = 1;
    open.push_back(static_cast<int>(seed));
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (const int e : topology.triangles[at(t)].edge) {
        const OpaqueTopology::Edge& edge = topology.edges[at(e)];
        if (edge.count != 2) continue;
        const auto [a, b] = faces_at(topology, edge);
        const int next = a.triangle == t ? b.triangle : a.triangle;
        if (sense[at(next)] != 0) continue;
        sense[at(next)] = -sense[at(t)] * a.direction * b.direction;
        open.push_back(next);
      }
    }
  }
  return sense;
}

/// Unit normal of the triangle's own corners; zero if it is too thin to have one.
Vec3 normal_of(const OpaqueTopology& topology, const OpaqueTopology::Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  const Vec3 u = topology.vertices[at(b)] - topology.vertices[at(a)];
  const Vec3 v = topology.vertices[at(c)] - topology.vertices[at(a)];
  const Vec3 normal = u.cross(v);
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  if (!(normal.norm() > margins::flattest_triangle * longest)) return Vec3::Zero();
  return normal.normalized();
}

NormalCone cone_of(const OpaqueTopology& topology, const FlatTree::Node& node,
                   std::span<const int> edges, std::span<const Vec3> normals) {
  NormalCone cone;
  Vec3 sum = Vec3::Zero();
  const auto visit = [&](auto&& use) {
    for (int i = node.first; i < node.first + node.count; ++i) {
      const auto [a, b] = faces_at(topology, topology.edges[at(edges[at(i)])]);
      use(normals[at(a.triangle)]);
      use(normals[at(b.triangle)]);
    }
  };
  visit([&](const Vec3& normal) { sum += normal; });
  cone.centre = 0.5 * (node.box.low + node.box.high);
  if (!(sum.norm() > 0)) return cone;
  const Vec3 axis = sum.normalized();
  double sine = 0;
  bool within = true;
  visit([&](const Vec3& normal) {
    within = within && axis.dot(normal) > 0;
    sine = std::max(sine, axis.cross(normal).norm());
  });
  if (!within || sine > margins::widest_cone) return cone;
  cone.axis = axis;
  cone.sine = sine;
  cone.cosine = std::sqrt(1 - sine * sine);
  for (int i = node.first; i < node.first + node.count; ++i)
    for (const int v :
         {topology.edges[at(edges[at(i)])].from, topology.edges[at(edges[at(i)])].to}) {
      const Vec3 offset = topology.vertices[at(v)] - cone.centre;
      cone.thickness = std::max(cone.thickness, std::abs(axis.dot(offset)));
      cone.radius = std::max(cone.radius, offset.norm());
    }
  return cone;
}

FlatTree tree_over(const OpaqueTopology& topology, const std::vector<int>& chosen) {
  std::vector<Bounds> boxes;
  for (const int e : chosen) boxes.push_back(box_of(topology, topology.edges[at(e)]));
  FlatTree tree = make_tight_tree(boxes);
  for (int& item : tree.items) item = chosen[at(item)];
  return tree;
}

/// Whether an edge has two faces that continue each other and both have a normal.
bool is_closed(const OpaqueTopology& topology, const OpaqueTopology::Edge& edge,
               std::span<const int> sense, std::span<const Vec3> normals) {
  if (edge.count != 2) return false;
  const auto [a, b] = faces_at(topology, edge);
  return a.direction * sense[at(a.triangle)] == -b.direction * sense[at(b.triangle)] &&
         !normals[at(a.triangle)].isZero() && !normals[at(b.triangle)].isZero();
}

}  // namespace

SilhouetteTrees make_silhouette_trees(const OpaqueTopology& topology) {
  const std::vector<int> sense = align(topology);
  std::vector<Vec3> normals;
  for (std::size_t t = 0; t < sense.size(); ++t)
    normals.push_back(sense[t] * normal_of(topology, topology.triangles[t]));
  std::vector<int> closed, open;
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    (is_closed(topology, topology.edges[e], sense, normals) ? closed : open)
        .push_back(static_cast<int>(e));
  SilhouetteTrees trees{tree_over(topology, closed), {}, tree_over(topology, open)};
  for (const FlatTree::Node& node : trees.closed_edges.nodes)
    trees.cones.push_back(cone_of(topology, node, trees.closed_edges.items, normals));
  return trees;
}

}  // namespace halfshade
