#include "meshing/patches/merge_elements.h"

#include "meshing/core/error.h"
#include "meshing/patches/detail/element_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

namespace halfshade {
namespace {

using Corners = std::array<int, 3>;

bool contains(const Corners& corners, int vertex) {
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

Corners corners_of(const TriangleMesh& mesh, FaceHandle face) {
  Corners corners{};
  auto half = mesh.halfedge_handle(face);
  for (int& corner : corners) {
    corner = mesh.from_vertex_handle(half).idx();
    half = mesh.next_halfedge_handle(half);
  }
  return corners;
}

/// Which splits can be undone together.
class MergeChoice {
 public:
  MergeChoice(const ElementMesh& mesh, std::span<const FaceHandle> named) : mesh_(mesh) {
    const std::vector<int>& parent = mesh.forest.parent;
    std::vector<int> missing(parent.size(), 0);  // parts of each node that are not named
    for (const int whole : parent)
      if (whole >= 0) ++missing[at(whole)];
    std::vector<bool> is_named(parent.size(), false);
    for (const auto face : named) is_named[at(node_of(face))] = true;
    merges_.assign(parent.size(), false);
    for (std::size_t node = 0; node < parent.size(); ++node)
      if (is_named[node] && parent[node] >= 0)
        merges_[at(parent[node])] = --missing[at(parent[node])] == 0;
    while (drop_kept()) continue;
  }

  /// [node]: takes the place of its parts.
  const std::vector<bool>& merges() const { return merges_; }

 private:
  int node_of(FaceHandle face) const { return mesh_.triangles.data(face).node; }

  int merging_whole(FaceHandle face) const {
    const int whole = mesh_.forest.parent[at(node_of(face))];
    return whole >= 0 && merges_[at(whole)] ? whole : -1;
  }

  /// Splits stay whose middles are needed by others. False if there are none of them.
  bool drop_kept() {
    const TriangleMesh& mesh = mesh_.triangles;
    std::vector<bool> stays(mesh.n_vertices(), false), shared_stays(at(mesh_.shared_points), false);
    for (const auto face : mesh.faces()) {
      const int whole = merging_whole(face);
      for (const int v : corners_of(mesh, face)) {
        if (whole >= 0 && !contains(mesh_.forest.corners[at(whole)], v)) continue;
        stays[at(v)] = true;
        if (const int s = mesh.data(VertexHandle(v)).shared_point; s >= 0)
          shared_stays[at(s)] = true;
      }
    }
    bool is_changed = false;
    for (const auto face : mesh.faces()) {
      const int whole = merging_whole(face);
      if (whole < 0) continue;
      for (const int v : corners_of(mesh, face)) {
        if (contains(mesh_.forest.corners[at(whole)], v)) continue;
        const int s = mesh.data(VertexHandle(v)).shared_point;
        if (!stays[at(v)] && !(s >= 0 && shared_stays[at(s)])) continue;
        merges_[at(whole)] = false;
        is_changed = true;
      }
    }
    return is_changed;
  }

  const ElementMesh& mesh_;
  std::vector<bool> merges_;
};

struct NewFace {
  Corners corners, order;  // of the edge from each corner to the next
  int node = -1;
};

std::vector<NewFace> faces_after(const ElementMesh& mesh, const std::vector<bool>& merges) {
  const TriangleMesh& triangles = mesh.triangles;
  const ElementForest& forest = mesh.forest;
  std::vector<NewFace> faces;
  for (const auto face : triangles.faces()) {
    const int node = triangles.data(face).node, whole = forest.parent[at(node)];
    if (whole >= 0 && merges[at(whole)]) continue;
    NewFace kept{corners_of(triangles, face), {}, node};
    auto half = triangles.halfedge_handle(face);
    for (int& order : kept.order) {
      order = triangles.data(triangles.edge_handle(half)).order;
      half = triangles.next_halfedge_handle(half);
    }
    faces.push_back(kept);
  }
  for (int node = 0; node < forest.count(); ++node)
    if (merges[at(node)])
      faces.push_back({forest.corners[at(node)], forest.edge_order[at(node)], node});
  return faces;
}

/// Without the parts of what merges. Returns old → new.
std::vector<int> compact(ElementForest& forest, const std::vector<bool>& merges) {
  ElementForest result;
  std::vector<int> now(merges.size(), -1);
  for (int node = 0; node < forest.count(); ++node) {
    const int whole = forest.parent[at(node)];
    if (whole >= 0 && merges[at(whole)]) continue;
    now[at(node)] =
        whole < 0 ? result.add_root(forest.surface[at(node)]) : result.add_child(now[at(whole)]);
    result.corners.back() = forest.corners[at(node)];
    result.edge_order.back() = forest.edge_order[at(node)];
  }
  forest = std::move(result);
  return now;
}

/// Old → new vertex, −1 for those that go; adds the others to `mesh`.
std::vector<int> keep_vertices(const TriangleMesh& before, std::span<const NewFace> faces,
                               TriangleMesh& mesh) {
  std::vector<int> now(before.n_vertices(), -1);
  for (const NewFace& face : faces)
    for (const int v : face.corners) now[at(v)] = 0;
  for (const auto vertex : before.vertices()) {
    if (now[at(vertex.idx())] < 0) continue;
    const auto added = mesh.add_vertex(before.point(vertex));
    mesh.data(added).shared_point = before.data(vertex).shared_point;
    now[at(vertex.idx())] = added.idx();
  }
  return now;
}

void add(TriangleMesh& mesh, const NewFace& face) {
  const auto& [a, b, c] = face.corners;
  const auto added = mesh.add_face(VertexHandle(a), VertexHandle(b), VertexHandle(c));
  if (!added.is_valid())
    throw Error(ErrorCode::contract, "PatchMesh", "merged elements are not a surface");
  mesh.data(added).node = face.node;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto half =
        mesh.find_halfedge(VertexHandle(face.corners[k]), VertexHandle(face.corners[(k + 1) % 3]));
    mesh.data(mesh.edge_handle(half)).order = face.order[k];
  }
}

}  // namespace

std::vector<int> merge_parts(ElementMesh& mesh, std::span<const int> elements) {
  const std::vector<bool> merges = MergeChoice(mesh, named_faces(mesh, elements)).merges();
  std::vector<NewFace> faces = faces_after(mesh, merges);
  TriangleMesh after;
  const std::vector<int> vertex_now = keep_vertices(mesh.triangles, faces, after);
  const std::vector<int> node_now = compact(mesh.forest, merges);
  for (Corners& corners : mesh.forest.corners)
    for (int& corner : corners) corner = corner < 0 ? -1 : vertex_now[at(corner)];
  for (NewFace& face : faces) {
    face.node = node_now[at(face.node)];
    for (int& corner : face.corners) corner = vertex_now[at(corner)];
    add(after, face);
  }
  mesh.triangles = std::move(after);
  std::vector<EdgeHandle> borders;
  for (const auto edge : mesh.triangles.edges())
    if (mesh.triangles.data(edge).order == 0) borders.push_back(edge);
  link_twins(mesh.triangles, borders);
  return node_now;
}

}  // namespace halfshade
