#pragma once

#include "meshing/core/progress.h"
#include "meshing/patches/shared_edges.h"
#include "meshing/triangulation/curve_mesh.h"

#include <vector>

namespace halfshade {

/// What the surfaces are meshed with, one entry a surface.
struct SurfaceMeshInput {
  std::vector<std::vector<CurvePolyline>> curves;
  std::vector<CurveMeshOptions> options;
};

/// No curves, and each surface's features resolved as far as it pays.
SurfaceMeshInput without_curves(const SoundScene& scene, const PlanarMeshOptions& options);

/// One mesh a surface.
struct SurfaceMeshes {
  std::vector<CurveMesh> meshes;
  int rounds = 0;  ///< until borders were subdivided alike
};

/// Meshes every surface by mesh_with_curves, on all threads, and again those whose borders differ
/// from their neighbours', with the neighbours' points on them, until nothing differs or it has
/// been tried often enough. If `progress` is stopped, surfaces not yet reached stay coarse, without
/// curves and incomplete. Throws Error(too_large) for more than `max_triangles` in all.
SurfaceMeshes mesh_surfaces(const SurfaceMeshInput& input, SharedEdges& shared,
                            std::size_t max_triangles, const Progress& progress);

/// Throws Error(too_large) where areas alone tell that `options` take too many triangles.
void check_size(const SoundScene& scene, const PlanarMeshOptions& options);

}  // namespace halfshade
