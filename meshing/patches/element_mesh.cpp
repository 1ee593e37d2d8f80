#include "meshing/patches/detail/element_mesh.h"

#include "meshing/core/error.h"
#include "meshing/geometry/link.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace halfshade {

int ElementForest::add_root(int of_surface) {
  parent.push_back(-1);
  level.push_back(0);
  surface.push_back(of_surface);
  corners.push_back({-1, -1, -1});
  edge_order.push_back({-1, -1, -1});
  return count() - 1;
}

int ElementForest::add_child(int of_node) {
  parent.push_back(of_node);
  level.push_back(level[at(of_node)] + 1);
  surface.push_back(surface[at(of_node)]);
  corners.push_back({-1, -1, -1});
  edge_order.push_back({-1, -1, -1});
  return count() - 1;
}

Vec3 position(const TriangleMesh& mesh, int vertex) {
  const OpenMesh::Vec3d& p = mesh.point(VertexHandle(vertex));
  return {p[0], p[1], p[2]};
}

Link ends(const TriangleMesh& mesh, EdgeHandle edge) {
  const auto half = mesh.halfedge_handle(edge, 0);
  return sorted_link(mesh.from_vertex_handle(half).idx(), mesh.to_vertex_handle(half).idx());
}

Link shared_ends(const TriangleMesh& mesh, EdgeHandle edge) {
  const Link link = ends(mesh, edge);
  return sorted_link(mesh.data(VertexHandle(link[0])).shared_point,
                     mesh.data(VertexHandle(link[1])).shared_point);
}

VertexHandle split_edge(TriangleMesh& mesh, EdgeHandle edge, const OpenMesh::Vec3d& middle) {
  struct Side {
    VertexHandle apex;
    int node;
  };
  std::vector<Side> sides;
  for (unsigned k = 0; k < 2; ++k) {
    const auto half = mesh.halfedge_handle(edge, k);
    if (const auto face = mesh.face_handle(half); face.is_valid())
      sides.push_back(
          {mesh.to_vertex_handle(mesh.next_halfedge_handle(half)), mesh.data(face).node});
  }
  const Link old_ends = ends(mesh, edge);
  const int order = mesh.data(edge).order;
  const auto vertex = mesh.add_vertex(middle);
  mesh.split(edge, vertex);
  for (const auto half : mesh.voh_range(vertex)) {
    const int other = mesh.to_vertex_handle(half).idx();
    auto& data = mesh.data(mesh.edge_handle(half));
    data.marked = false;
    data.twin = -1;
    data.order = other == old_ends[0] || other == old_ends[1] ? order : -1;
    for (const Side& side : sides) {
      if (side.apex.idx() != other) continue;
      mesh.data(mesh.face_handle(half)).node = side.node;
      mesh.data(mesh.face_handle(mesh.opposite_halfedge_handle(half))).node = side.node;
    }
  }
  return vertex;
}

void link_twins(TriangleMesh& mesh, const std::vector<EdgeHandle>& edges) {
  std::vector<std::pair<Link, int>> keys;
  for (const auto edge : edges)
    if (const Link key = shared_ends(mesh, edge); key[0] >= 0) keys.emplace_back(key, edge.idx());
  std::sort(keys.begin(), keys.end());
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    while (last < keys.size() && keys[last].first == keys[first].first) ++last;
    for (std::size_t i = first; i < last && last - first > 1; ++i)
      mesh.data(EdgeHandle(keys[i].second)).twin = keys[i + 1 < last ? i + 1 : first].second;
  }
}

std::vector<FaceHandle> ordered_faces(const ElementMesh& mesh) {
  const TriangleMesh& triangles = mesh.triangles;
  std::vector<FaceHandle> faces(triangles.faces_begin(), triangles.faces_end());
  std::sort(faces.begin(), faces.end(), [&](auto a, auto b) {
    const int m = triangles.data(a).node, n = triangles.data(b).node;
    return std::pair(mesh.forest.surface[at(m)], m) < std::pair(mesh.forest.surface[at(n)], n);
  });
  return faces;
}

std::vector<FaceHandle> named_faces(const ElementMesh& mesh, std::span<const int> elements) {
  const std::vector<FaceHandle> faces = ordered_faces(mesh);
  std::vector<FaceHandle> named;
  for (const int e : elements) {
    if (e < 0 || e >= static_cast<int>(faces.size()))
      throw Error(ErrorCode::contract, "PatchMesh",
                  fmt::format("element {} is named, but there are {}", e, faces.size()));
    named.push_back(faces[at(e)]);
  }
  return named;
}

}  // namespace halfshade
