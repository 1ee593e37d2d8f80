#include "meshing/backprojection/opaque_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace halfshade {
namespace {

using Impl = OpaqueScene::Impl;

// A triangle flatter than this, relative to its longest edge squared, has no trustworthy normal.
constexpr double flattest = 1e-10;

Bounds box_of(const Impl& scene, const Impl::Edge& edge) {
  Bounds box{scene.vertices[at(edge.from)], scene.vertices[at(edge.from)]};
  box.include(scene.vertices[at(edge.to)]);
  return box;
}

Bounds box_of(const Impl& scene, const Impl::Triangle& triangle) {
  Bounds box{scene.vertices[at(triangle.corner[0])], scene.vertices[at(triangle.corner[0])]};
  for (const int v : triangle.corner) box.include(scene.vertices[at(v)]);
  return box;
}

/// Fills edges, incidences and the triangles' edges.
void connect(Impl& scene) {
  struct Use {
    int from, to, triangle, side, direction;
  };
  std::vector<Use> uses;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = scene.triangles[t].corner[at(k)],
                b = scene.triangles[t].corner[at((k + 1) % 3)];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), k, a < b ? 1 : -1});
    }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.from, a.to, a.triangle, a.side) < std::tie(b.from, b.to, b.triangle, b.side);
  });
  for (const Use& use : uses) {
    if (scene.edges.empty() || scene.edges.back().from != use.from ||
        scene.edges.back().to != use.to)
      scene.edges.push_back({use.from, use.to, static_cast<int>(scene.incidences.size()), 0});
    ++scene.edges.back().count;
    scene.incidences.push_back({use.triangle, use.direction});
    scene.triangles[at(use.triangle)].edge[at(use.side)] = static_cast<int>(scene.edges.size()) - 1;
  }
}

/// The two faces at an edge that has just two.
struct Pair {
  Impl::Incidence a, b;
};
Pair faces_at(const Impl& scene, const Impl::Edge& edge) {
  return {scene.incidences[at(edge.first)], scene.incidences[at(edge.first) + 1]};
}

/// ±1 for each triangle, so that neighbours look the same way where that can be.
std::vector<int> align(const Impl& scene) {
  std::vector<int> sense(scene.triangles.size(), 0), open;
  for (std::size_t seed = 0; seed < sense.size(); ++seed) {
    if (sense[seed] != 0) continue;
    sense[seed] = 1;
    open.push_back(static_cast<int>(seed));
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (const int e : scene.triangles[at(t)].edge) {
        const Impl::Edge& edge = scene.edges[at(e)];
        if (edge.count != 2) continue;
        const auto [a, b] = faces_at(scene, edge);
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
Vec3 normal_of(const Impl& scene, const Impl::Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  const Vec3 u = scene.vertices[at(b)] - scene.vertices[at(a)];
  const Vec3 v = scene.vertices[at(c)] - scene.vertices[at(a)];
  const Vec3 normal = u.cross(v);
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  if (!(normal.norm() > flattest * longest)) return Vec3::Zero();
  return normal.normalized();
}

NormalCone cone_of(const Impl& scene, const FlatTree::Node& node, std::span<const int> edges,
                   std::span<const Vec3> normals) {
  NormalCone cone;
  Vec3 sum = Vec3::Zero();
  const auto visit = [&](auto&& use) {
    for (int i = node.first; i < node.first + node.count; ++i) {
      const auto [a, b] = faces_at(scene, scene.edges[at(edges[at(i)])]);
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
  if (!within || sine > 0.99) return cone;
  cone.axis = axis;
  cone.sine = sine;
  cone.cosine = std::sqrt(1 - sine * sine);
  for (int i = node.first; i < node.first + node.count; ++i)
    for (const int v : {scene.edges[at(edges[at(i)])].from, scene.edges[at(edges[at(i)])].to}) {
      const Vec3 offset = scene.vertices[at(v)] - cone.centre;
      cone.thickness = std::max(cone.thickness, std::abs(axis.dot(offset)));
      cone.radius = std::max(cone.radius, offset.norm());
    }
  return cone;
}

FlatTree tree_over(const Impl& scene, std::vector<int>& chosen) {
  std::vector<Bounds> boxes;
  for (const int e : chosen) boxes.push_back(box_of(scene, scene.edges[at(e)]));
  FlatTree tree = make_flat_tree(boxes);
  for (int& item : tree.items) item = chosen[at(item)];
  return tree;
}

void build_trees(Impl& scene) {
  std::vector<int> sense = align(scene);
  std::vector<Vec3> normals;
  for (std::size_t t = 0; t < sense.size(); ++t)
    normals.push_back(sense[t] * normal_of(scene, scene.triangles[t]));
  std::vector<int> closed, open;
  for (std::size_t e = 0; e < scene.edges.size(); ++e) {
    const Impl::Edge& edge = scene.edges[e];
    bool is_closed = edge.count == 2;
    if (is_closed) {
      const auto [a, b] = faces_at(scene, edge);
      is_closed = a.direction * sense[at(a.triangle)] == -b.direction * sense[at(b.triangle)] &&
                  !normals[at(a.triangle)].isZero() && !normals[at(b.triangle)].isZero();
    }
    (is_closed ? closed : open).push_back(static_cast<int>(e));
  }
  scene.closed_edges = tree_over(scene, closed);
  scene.open_edges = tree_over(scene, open);
  for (const FlatTree::Node& node : scene.closed_edges.nodes)
    scene.cones.push_back(cone_of(scene, node, scene.closed_edges.items, normals));
  std::vector<Bounds> boxes;
  for (const Impl::Triangle& triangle : scene.triangles) boxes.push_back(box_of(scene, triangle));
  scene.faces = make_flat_tree(boxes);
}

}  // namespace

OpaqueScene::OpaqueScene(const SoundScene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->tolerance = scene.tolerance;
  join_outlines(scene, *impl_);
  cut_into_triangles(scene, *impl_);
  connect(*impl_);
  build_trees(*impl_);
}

int OpaqueScene::edge_count() const { return static_cast<int>(impl_->edges.size()); }

std::array<Vec3, 2> OpaqueScene::edge_ends(int edge) const {
  const Impl::Edge& e = impl_->edges[at(edge)];
  return {impl_->vertices[at(e.from)], impl_->vertices[at(e.to)]};
}

OpaqueScene::~OpaqueScene() = default;
OpaqueScene::OpaqueScene(OpaqueScene&&) noexcept = default;
OpaqueScene& OpaqueScene::operator=(OpaqueScene&&) noexcept = default;

}  // namespace halfshade
