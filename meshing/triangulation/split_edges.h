#pragma once

#include "meshing/triangulation/planar_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Points on an edge of a mesh.
struct EdgePoints {
  std::array<int, 2> edge{};
  std::vector<Vec2> points;  ///< from the first end of the edge to the second
};

/// Splits edges at points on them, each once, and the triangles at them. Parts of constrained edges
/// are constrained.
void split_edges(PlanarMesh& mesh, std::span<const EdgePoints> edges);

/// The same, after which the mesh is refined on towards `options` where they no longer hold. Points
/// stay where they are. As with refine_triangulation, `complete` tells whether that worked.
void split_and_refine(PlanarMesh& mesh, std::span<const EdgePoints> edges,
                      const PlanarMeshOptions& options);

}  // namespace halfshade
