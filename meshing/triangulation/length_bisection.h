#pragma once

#include "meshing/triangulation/planar_mesh.h"

#include <cstddef>

namespace halfshade {

/// Bisects the longest edge of the mesh again and again until none is longer than `max_length` (0:
/// no limit). The longest edge of all is the longest of both its triangles, so the mesh stays
/// conforming. Clears `complete` if `max_triangles` comes first.
void bisect_long_edges(PlanarMesh& mesh, double max_length, std::size_t max_triangles);

}  // namespace halfshade
