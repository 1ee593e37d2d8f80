#include "meshing/triangulation/split_edges.h"

#include "meshing/triangulation/delaunay_refinement.h"
#include "meshing/triangulation/length_bisection.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace halfshade {
namespace {

// Rounding of a midpoint must not push an edge over the limit.
constexpr double length_margin = 1e-12;

using Link = std::array<int, 2>;

Link sorted(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

class Splitter {
 public:
  Splitter(PlanarMesh& mesh, std::span<const EdgePoints> edges) : mesh_(mesh) {
    for (const EdgePoints& e : edges) triangles_[sorted(e.edge[0], e.edge[1])];
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& c = mesh.triangles[static_cast<std::size_t>(t)];
        const auto found = triangles_.find(sorted(c[k], c[(k + 1) % 3]));
        if (found != triangles_.end()) found->second.push_back(t);
      }
  }

  void split(const EdgePoints& edge) {
    const Link link = sorted(edge.edge[0], edge.edge[1]);
    const auto& constrained = mesh_.constrained_edges;
    const bool is_constrained = std::binary_search(constrained.begin(), constrained.end(), link);
    int from = edge.edge[0];
    for (const Vec2& p : edge.points) {
      const int middle = static_cast<int>(mesh_.points.size());
      mesh_.points.push_back(p);
      split(sorted(from, edge.edge[1]), edge.edge[1], middle);
      if (is_constrained) added_.push_back(sorted(from, middle));
      from = middle;
    }
    if (!is_constrained) return;
    added_.push_back(sorted(from, edge.edge[1]));
    gone_.insert(link);
  }

  void update_constrained() {
    auto& edges = mesh_.constrained_edges;
    std::erase_if(edges, [&](const Link& link) { return gone_.contains(link); });
    edges.insert(edges.end(), added_.begin(), added_.end());
    std::sort(edges.begin(), edges.end());
  }

 private:
  // Afterwards the triangles between the middle and `to` are known.
  void split(const Link& link, int to, int middle) {
    const std::vector<int> sides = triangles_[link];
    triangles_.erase(link);
    for (const int t : sides) {
      auto& corners = mesh_.triangles[static_cast<std::size_t>(t)];
      std::size_t k = 0;
      while (sorted(corners[k], corners[(k + 1) % 3]) != link) ++k;
      const int a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      const int added = static_cast<int>(mesh_.triangles.size());
      corners = {a, middle, c};
      mesh_.triangles.push_back({middle, b, c});
      if (const auto next = triangles_.find(sorted(b, c)); next != triangles_.end())
        std::replace(next->second.begin(), next->second.end(), t, added);
      triangles_[sorted(middle, to)].push_back(b == to ? added : t);
    }
  }

  PlanarMesh& mesh_;
  std::map<Link, std::vector<int>> triangles_;  // at the edges to be split
  std::set<Link> gone_;
  std::vector<Link> added_;
};

}  // namespace

void split_edges(PlanarMesh& mesh, std::span<const EdgePoints> edges) {
  Splitter splitter(mesh, edges);
  for (const EdgePoints& edge : edges) splitter.split(edge);
  splitter.update_constrained();
}

void split_and_refine(PlanarMesh& mesh, std::span<const EdgePoints> edges,
                      const PlanarMeshOptions& options) {
  split_edges(mesh, edges);
  if (!mesh.complete) return;
  PlanarMeshOptions inner = options;
  inner.max_length = options.max_length * (1 - length_margin);
  if (auto refined = delaunay_refinement(mesh, inner))
    mesh = std::move(*refined);
  else
    mesh.complete = false;
  bisect_long_edges(mesh, inner.max_length, inner.max_triangles);
}

}  // namespace halfshade
