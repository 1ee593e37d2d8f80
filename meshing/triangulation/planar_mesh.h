#pragma once

#include "meshing/core/sound_scene.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

struct PlanarMeshOptions {
  double max_length = 0;    ///< no edge longer than this, in scene units; 0: no limit
  double min_angle = 20.7;  ///< degrees, in [0, 20.7]; input angles below it are left as they are
  std::size_t max_triangles = 1000000;  ///< refinement stops here
};

/// A conforming triangulation in the coordinates of a surface's frame.
struct PlanarMesh {
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
  /// Edges that lie on rings or contact lines, as sorted pairs of points, sorted.
  std::vector<std::array<int, 2>> constrained_edges;
  /// False where the refinement ended early: at max_triangles, or because the polygon is so thin
  /// that good angles would take far more triangles than its size deserves. Edge lengths hold in
  /// the second case.
  bool complete = true;
};

/// The constrained Delaunay triangulation of a polygon with holes, without further points except
/// where contact lines cross.
PlanarMesh triangulate(std::span<const Ring> rings, std::span<const Segment2> contacts);

/// The same, refined by Delaunay refinement (Chew 1993, Ruppert 1995) until every angle that the
/// input does not force is at least `min_angle` and every edge is at most `max_length` long.
/// Deterministic. Throws Error(contract) for options out of range.
PlanarMesh refine_triangulation(std::span<const Ring> rings, std::span<const Segment2> contacts,
                                const PlanarMeshOptions& options);

}  // namespace halfshade
