#pragma once

#include "meshing/core/progress.h"
#include "meshing/patches/shared_edges.h"
#include "meshing/triangulation/curve_mesh.h"
#include "meshing/triangulation/planar_mesh.h"

#include <span>
#include <vector>

namespace halfshade {

/// Meshes every surface by refine_triangulation, in parallel, with walls subdivided alike as far
/// as it comes to that in a few rounds. Throws Error(too_large) for more than
/// `options.max_triangles` in all. If `progress` is stopped, surfaces not yet reached stay coarse.
std::vector<PlanarMesh> mesh_surfaces(const SoundScene& scene, const PlanarMeshOptions& options,
                                      SharedEdges& shared, const Progress& progress);

/// Throws Error(too_large) where areas alone tell that `options` take too many triangles.
void check_size(const SoundScene& scene, const PlanarMeshOptions& options);

/// Throws Error(too_large) if the meshes of the first `surface` + 1 of `surfaces` surfaces have
/// more triangles than are allowed.
void check_count(std::size_t count, std::size_t allowed, std::size_t surface, std::size_t surfaces);

/// All constrained edges.
WallEdges wall_edges(const PlanarMesh& mesh);
/// The constrained edges on rings and contact lines.
WallEdges wall_edges(const CurveMesh& mesh);

/// A mesh all of whose constrained edges lie on rings and contact lines.
CurveMesh without_curves(PlanarMesh mesh);

/// [constrained edge]: the lowest order of what lies there; 0 on rings and contact lines. Throws
/// Error(contract) if a curve has no order.
std::vector<int> edge_orders(const CurveMesh& mesh, std::span<const int> curve_order);

}  // namespace halfshade
