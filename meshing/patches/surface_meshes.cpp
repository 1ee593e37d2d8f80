#include "meshing/patches/surface_meshes.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

WallEdge wall_edge(const PlanarMesh& mesh, const std::array<int, 2>& edge) {
  return {edge, {mesh.points[at(edge[0])], mesh.points[at(edge[1])]}};
}

}  // namespace

// No triangle with edges up to h is larger than the equilateral one.
void check_size(const SoundScene& scene, const PlanarMeshOptions& options) {
  double least = 0;
  if (options.max_length > 0)
    for (const Surface& surface : scene.surfaces)
      least += area(surface) / options.max_length / options.max_length / (std::sqrt(3.0) / 4);
  if (least > static_cast<double>(options.max_triangles))
    throw Error(ErrorCode::too_large, "PatchMesh",
                fmt::format("edges of at most {} need at least {:.0f} elements; {} are allowed",
                            options.max_length, least, options.max_triangles));
}

void check_count(std::size_t count, std::size_t allowed, std::size_t surface,
                 std::size_t surfaces) {
  if (count > allowed)
    throw Error(ErrorCode::too_large, "PatchMesh",
                fmt::format("more than {} elements are needed; surface {} of {} takes the count "
                            "to {}",
                            allowed, surface + 1, surfaces, count));
}

std::vector<PlanarMesh> mesh_surfaces(const SoundScene& scene, const PlanarMeshOptions& options,
                                      SharedEdges& shared, const Progress& progress) {
  check_size(scene, options);
  std::vector<PlanarMesh> meshes(scene.surfaces.size());
  std::vector<int> times(meshes.size(), 0);
  mesh_alike(
      shared, meshes.size(),
      [&](std::size_t r, const Outline& outline) {
        // Meshed anew once, which forgets points that neighbours have elsewhere; afterwards refined
        // on, which changes least.
        if (times[r]++ < 2)
          meshes[r] = refine_triangulation(outline.rings, outline.contacts, options);
        else
          split_and_refine(meshes[r], shared.missing(static_cast<int>(r), wall_edges(meshes[r])),
                           options);
      },
      [&](std::size_t r) { return wall_edges(meshes[r]); }, progress);
  std::size_t count = 0;
  for (std::size_t r = 0; r < meshes.size(); ++r) {
    if (meshes[r].triangles.empty()) {
      const Outline outline = shared.outline(static_cast<int>(r));
      meshes[r] = triangulate(outline.rings, outline.contacts);
    }
    count += meshes[r].triangles.size();
    check_count(count, options.max_triangles, r, meshes.size());
  }
  return meshes;
}

WallEdges wall_edges(const PlanarMesh& mesh) {
  WallEdges walls;
  for (const auto& edge : mesh.constrained_edges) walls.push_back(wall_edge(mesh, edge));
  return walls;
}

WallEdges wall_edges(const CurveMesh& mesh) {
  WallEdges walls;
  for (std::size_t i = 0; i < mesh.mesh.constrained_edges.size(); ++i)
    if (mesh.is_d0[i]) walls.push_back(wall_edge(mesh.mesh, mesh.mesh.constrained_edges[i]));
  return walls;
}

CurveMesh without_curves(PlanarMesh mesh) {
  CurveMesh result;
  result.is_d0.assign(mesh.constrained_edges.size(), true);
  result.curve_begin.assign(mesh.constrained_edges.size() + 1, 0);
  result.mesh = std::move(mesh);
  return result;
}

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

}  // namespace halfshade
