#pragma once

#include "meshing/triangulation/planar_mesh.h"

#include <optional>

namespace halfshade {

/// Refines a triangulation towards the angle and length of `options` by Delaunay refinement.
/// Nothing comes back where that takes more triangles than the shape deserves (needles, near
/// overlaps) or where the arithmetic of the refinement fails; the triangulation is then to be used
/// as it is. A few edges may come out too long at narrow input angles.
std::optional<PlanarMesh> delaunay_refinement(const PlanarMesh& coarse,
                                              const PlanarMeshOptions& options);

}  // namespace halfshade
