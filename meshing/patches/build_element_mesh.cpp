#include "meshing/patches/build_element_mesh.h"

#include "meshing/core/error.h"
#include "meshing/geometry/corner_fans.h"
#include "meshing/geometry/link.h"
#include "meshing/patches/detail/element_mesh.h"
#include "meshing/patches/shared_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace halfshade {
namespace {

OpenMesh::Vec3d to_openmesh(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// [constrained edge]: the lowest order of what lies there; 0 on rings and contact lines.
std::vector<int> edge_orders(const CurveMesh& mesh, std::span<const int> curve_order) {
  std::vector<int> orders;
  for (std::size_t i = 0; i < mesh.mesh.constrained_edges.size(); ++i) {
    int order = mesh.is_d0[i] ? 0 : -1;
    for (int k = mesh.curve_begin[i]; k < mesh.curve_begin[i + 1]; ++k) {
      const int id = mesh.curves[at(k)];
      if (id < 0 || at(id) >= curve_order.size())
        throw Error(
            ErrorCode::contract, "PatchMesh",
            fmt::format("a mesh names curve {}, but {} have an order", id, curve_order.size()));
      const int own = curve_order[at(id)];
      order = order < 0 ? own : std::min(order, own);
    }
    orders.push_back(order);
  }
  return orders;
}

// Adds the mesh of one surface. Where triangles touch in a point without sharing an edge, the point
// becomes several vertices, for OpenMesh takes manifold meshes only.
class SurfaceAdder {
 public:
  SurfaceAdder(ElementMesh& out, int surface, const PlanarMesh& planar)
      : out_(out), surface_(surface), planar_(planar) {
    fans_ = corner_fans(planar.triangles, edge_neighbours(planar.triangles));
    point_.resize(at(fans_.count));
    for (std::size_t t = 0; t < planar.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        point_[at(fans_.of_corner[t][k])] = planar.triangles[t][k];
  }

  void add_vertices(const PlaneFrame& frame, const SharedPoints& shared) {
    for (const int point : point_) {
      const int id = shared.id[at(surface_)][at(point)];
      const Vec3 p = id < 0 ? frame.to_space(planar_.points[at(point)]) : shared.position[at(id)];
      vertices_.push_back(out_.triangles.add_vertex(to_openmesh(p)));
      out_.triangles.data(vertices_.back()).shared_point = id;
    }
  }

  void add_faces(std::span<const int> orders) {
    TriangleMesh& mesh = out_.triangles;
    const auto& constrained = planar_.constrained_edges;
    for (const auto& corners : fans_.of_corner) {
      const auto face = mesh.add_face(vertices_[at(corners[0])], vertices_[at(corners[1])],
                                      vertices_[at(corners[2])]);
      if (!face.is_valid())
        throw Error(ErrorCode::contract, "PatchMesh",
                    fmt::format("the triangulation of surface {} is not a surface", surface_));
      mesh.data(face).node = out_.forest.add_root(surface_);
      for (const auto edge : mesh.fe_range(face)) {
        const Link link = ends(mesh, edge);
        const Link key = sorted_link(point_of(link[0]), point_of(link[1]));
        const auto found = std::lower_bound(constrained.begin(), constrained.end(), key);
        if (found != constrained.end() && *found == key)
          mesh.data(edge).order = orders[static_cast<std::size_t>(found - constrained.begin())];
      }
    }
  }

  // Splits edges where only neighbours have points. The parts are elements of their own.
  void fill_gaps(const SharedPoints& shared) {
    const auto& gaps = shared.gaps[at(surface_)];
    if (gaps.empty()) return;
    TriangleMesh& mesh = out_.triangles;
    std::map<Link, EdgeHandle> edges;
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      for (const auto half : mesh.voh_range(vertices_[v]))
        edges.emplace(Link{point_[v], point_of(mesh.to_vertex_handle(half).idx())},
                      mesh.edge_handle(half));
    for (const auto& gap : gaps) {
      auto edge = edges.at(gap.edge);
      Link link = ends(mesh, edge);
      if (point_of(link[1]) != gap.edge[1]) std::swap(link[0], link[1]);
      for (const int id : gap.points) {
        const auto middle = split_edge(mesh, edge, to_openmesh(shared.position[at(id)]));
        mesh.data(middle).shared_point = id;
        std::map<int, FaceHandle> halves;  // of one triangle, by its node
        for (const auto face : mesh.vf_range(middle))
          if (!halves.emplace(mesh.data(face).node, face).second)
            mesh.data(face).node = out_.forest.add_root(surface_);
        edge = mesh.edge_handle(mesh.find_halfedge(middle, VertexHandle(link[1])));
      }
    }
  }

 private:
  // Of the planar mesh. A vertex that filled a gap is none of them, and not asked for.
  int point_of(int vertex) const { return point_[at(vertex - vertices_.front().idx())]; }

  ElementMesh& out_;
  int surface_;
  const PlanarMesh& planar_;
  CornerFans fans_;
  std::vector<int> point_;              // [fan] its point of the planar mesh
  std::vector<VertexHandle> vertices_;  // [fan]
};

}  // namespace

ElementMesh build_element_mesh(const SoundScene& scene, const SharedEdges& shared,
                               std::span<const CurveMesh> meshes,
                               std::span<const int> curve_order) {
  const SharedPoints common = shared_points(scene, shared, meshes);
  ElementMesh result;
  result.shared_points = static_cast<int>(common.position.size());
  for (std::size_t r = 0; r < meshes.size(); ++r) {
    SurfaceAdder adder(result, static_cast<int>(r), meshes[r].mesh);
    adder.add_vertices(scene.surfaces[r].frame, common);
    adder.add_faces(edge_orders(meshes[r], curve_order));
    adder.fill_gaps(common);
  }
  std::vector<EdgeHandle> borders;
  for (const auto edge : result.triangles.edges())
    if (result.triangles.data(edge).order == 0) borders.push_back(edge);
  link_twins(result.triangles, borders);
  return result;
}

}  // namespace halfshade
