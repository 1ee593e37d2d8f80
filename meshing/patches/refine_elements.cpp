#include "meshing/patches/refine_elements.h"

#include "meshing/core/rounded.h"
#include "meshing/geometry/link.h"
#include "meshing/patches/detail/element_mesh.h"

#include <algorithm>
#include <map>
#include <utility>

namespace halfshade {
namespace {

/// Of squared lengths that are compared: both long edges of a needle are alike to more than are
/// usual, and which is longer would depend on the unit.
constexpr int edge_digits = 20;

// A strict order of all edges, so that both triangles at an edge agree and the closure ends.
bool is_longer(const TriangleMesh& mesh, EdgeHandle a, EdgeHandle b) {
  const Link m = ends(mesh, a), n = ends(mesh, b);
  const auto length = [&](const Link& link) {
    return rounded<edge_digits>((position(mesh, link[1]) - position(mesh, link[0])).squaredNorm());
  };
  const double length_m = length(m), length_n = length(n);
  return length_m > length_n || (length_m == length_n && m < n);
}

EdgeHandle longest_edge(const TriangleMesh& mesh, FaceHandle face) {
  EdgeHandle best;
  for (const auto edge : mesh.fe_range(face))
    if (!best.is_valid() || is_longer(mesh, edge, best)) best = edge;
  return best;
}

// With all its twins.
void mark(TriangleMesh& mesh, EdgeHandle edge, std::vector<EdgeHandle>& marked) {
  while (!mesh.data(edge).marked) {
    mesh.data(edge).marked = true;
    marked.push_back(edge);
    if (mesh.data(edge).twin >= 0) edge = EdgeHandle(mesh.data(edge).twin);
  }
}

// Marks the longest edge of every triangle that has a marked edge.
void close_marks(TriangleMesh& mesh, std::vector<EdgeHandle>& marked) {
  for (std::size_t i = 0; i < marked.size(); ++i)
    for (unsigned side = 0; side < 2; ++side) {
      const auto face = mesh.face_handle(mesh.halfedge_handle(marked[i], side));
      if (face.is_valid()) mark(mesh, longest_edge(mesh, face), marked);
    }
}

// Splits a closed set of marked edges, longest first, so that each triangle is bisected at its
// longest edge before its parts are (green, blue); where all three edges were split, the inner edge
// is then turned to join the other two midpoints (red).
class MarkedSplitter {
 public:
  MarkedSplitter(ElementMesh& out, const std::vector<EdgeHandle>& marked)
      : out_(out), mesh_(out.triangles) {
    for (const auto edge : marked)
      for (unsigned side = 0; side < 2; ++side) {
        const auto face = mesh_.face_handle(mesh_.halfedge_handle(edge, side));
        if (!face.is_valid()) continue;
        bool all = true;
        for (const auto e : mesh_.fe_range(face)) all = all && mesh_.data(e).marked;
        is_red_[mesh_.data(face).node] = all;
        remember(face);
      }
  }

  void run(std::vector<EdgeHandle> marked) {
    std::sort(marked.begin(), marked.end(), [&](auto a, auto b) { return is_longer(mesh_, a, b); });
    for (const auto edge : marked) split(edge);
    link_twins(mesh_, halves_);
    for (const auto& [node, link] : inner_) {
      const auto half = mesh_.find_halfedge(VertexHandle(link[0]), VertexHandle(link[1]));
      mesh_.flip(mesh_.edge_handle(half));
    }
    name_children();
  }

 private:
  // What it takes to make the whole again.
  void remember(FaceHandle face) {
    const auto node = at(mesh_.data(face).node);
    auto half = mesh_.halfedge_handle(face);
    for (std::size_t k = 0; k < 3; ++k, half = mesh_.next_halfedge_handle(half)) {
      out_.forest.corners[node][k] = mesh_.from_vertex_handle(half).idx();
      out_.forest.edge_order[node][k] = mesh_.data(mesh_.edge_handle(half)).order;
    }
  }

  void split(EdgeHandle edge) {
    for (unsigned side = 0; side < 2; ++side) {
      const auto half = mesh_.halfedge_handle(edge, side);
      const auto face = mesh_.face_handle(half);
      if (!face.is_valid() || !is_red_.at(mesh_.data(face).node)) continue;
      const int apex = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(half)).idx();
      const int middle = static_cast<int>(mesh_.n_vertices());
      inner_.emplace(mesh_.data(face).node, Link{middle, apex});  // the first is the longest
    }
    const bool has_twin = mesh_.data(edge).twin >= 0;
    const Link link = ends(mesh_, edge), shared = shared_ends(mesh_, edge);
    const auto middle =
        split_edge(mesh_, edge,
                   0.5 * (mesh_.point(VertexHandle(link[0])) + mesh_.point(VertexHandle(link[1]))));
    if (!has_twin) return;
    const auto [found, is_new] = shared_middle_.emplace(shared, out_.shared_points);
    if (is_new) ++out_.shared_points;
    mesh_.data(middle).shared_point = found->second;
    for (const int end : link)
      halves_.push_back(mesh_.edge_handle(mesh_.find_halfedge(middle, VertexHandle(end))));
  }

  // Gives the parts of split elements nodes of their own, in the order of their parents.
  void name_children() {
    std::vector<std::pair<int, int>> parts;
    for (const auto face : mesh_.faces())
      if (is_red_.contains(mesh_.data(face).node))
        parts.emplace_back(mesh_.data(face).node, face.idx());
    std::sort(parts.begin(), parts.end());
    for (const auto& [node, face] : parts)
      mesh_.data(FaceHandle(face)).node = out_.forest.add_child(node);
  }

  ElementMesh& out_;
  TriangleMesh& mesh_;
  std::map<int, bool> is_red_;         // node of a split triangle → are all its edges split?
  std::map<int, Link> inner_;          // red node → middle of its longest edge, opposite corner
  std::map<Link, int> shared_middle_;  // ends of twins → shared point in their middle
  std::vector<EdgeHandle> halves_;     // of twins
};

void split_marked(ElementMesh& mesh, std::vector<EdgeHandle> marked) {
  close_marks(mesh.triangles, marked);
  MarkedSplitter splitter(mesh, marked);
  splitter.run(std::move(marked));
}

}  // namespace

void split_in_four(ElementMesh& mesh, std::span<const int> elements) {
  std::vector<EdgeHandle> marked;
  for (const auto face : named_faces(mesh, elements))
    for (const auto edge : mesh.triangles.fe_range(face)) mark(mesh.triangles, edge, marked);
  split_marked(mesh, std::move(marked));
}

void bisect(ElementMesh& mesh, std::span<const int> elements) {
  std::vector<EdgeHandle> marked;
  for (const auto face : named_faces(mesh, elements))
    mark(mesh.triangles, longest_edge(mesh.triangles, face), marked);
  split_marked(mesh, std::move(marked));
}

}  // namespace halfshade
