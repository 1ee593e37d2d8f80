#include "meshing/patches/make_element_table.h"

#include "meshing/geometry/corner_fans.h"
#include "meshing/patches/detail/element_mesh.h"

namespace halfshade {
namespace {

// The halfedge that leaves the corner that was made first.
HalfedgeHandle first_halfedge(const TriangleMesh& mesh, FaceHandle face) {
  const auto start = mesh.halfedge_handle(face);
  auto best = start;
  for (auto half = mesh.next_halfedge_handle(start); half != start;
       half = mesh.next_halfedge_handle(half))
    if (mesh.from_vertex_handle(half).idx() < mesh.from_vertex_handle(best).idx()) best = half;
  return best;
}

void describe(const std::array<Vec3, 3>& triangle, const SurfaceLabels& surface,
              ElementTable& table) {
  const auto& [a, b, c] = triangle;
  table.area.push_back(0.5 * (b - a).cross(c - a).norm());
  table.normal.push_back(surface.frame.normal);
  table.face.push_back(surface.faces.face_at(surface.frame.to_plane((a + b + c) / 3)));
  table.group.push_back(surface.group);
  table.material.push_back(surface.material);
}

}  // namespace

std::vector<SurfaceLabels> surface_labels(const SoundScene& scene) {
  std::vector<SurfaceLabels> labels;
  for (const Surface& surface : scene.surfaces)
    labels.push_back({surface.frame, surface.group, surface.material, FaceLookup(surface)});
  return labels;
}

ElementTable make_element_table(const ElementMesh& elements,
                                std::span<const SurfaceLabels> surfaces) {
  const TriangleMesh& mesh = elements.triangles;
  const std::vector<FaceHandle> faces = ordered_faces(elements);
  std::vector<int> element(faces.size());
  for (std::size_t e = 0; e < faces.size(); ++e) element[at(faces[e].idx())] = static_cast<int>(e);
  ElementTable table;
  std::vector<std::array<int, 3>> vertices;
  for (const auto face : faces) {
    std::array<int, 3> corners{}, across{}, order{};
    std::array<Vec3, 3> triangle;
    auto half = first_halfedge(mesh, face);
    for (std::size_t k = 0; k < 3; ++k, half = mesh.next_halfedge_handle(half)) {
      corners[k] = mesh.from_vertex_handle(half).idx();
      triangle[k] = position(mesh, corners[k]);
      const auto other = mesh.face_handle(mesh.opposite_halfedge_handle(half));
      order[k] = mesh.data(mesh.edge_handle(half)).order;
      across[k] = other.is_valid() && order[k] != 0 ? element[at(other.idx())] : -1;
    }
    vertices.push_back(corners);
    table.neighbours.push_back(across);
    table.edge_order.push_back(order);
    const int node = mesh.data(face).node;
    table.surface.push_back(elements.forest.surface[at(node)]);
    table.level.push_back(elements.forest.level[at(node)]);
    describe(triangle, surfaces[at(table.surface.back())], table);
  }
  const CornerFans fans = corner_fans(vertices, table.neighbours);
  table.points.resize(at(fans.count));
  table.corners = fans.of_corner;
  for (std::size_t e = 0; e < vertices.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      table.points[at(fans.of_corner[e][k])] = position(mesh, vertices[e][k]);
  return table;
}

}  // namespace halfshade
