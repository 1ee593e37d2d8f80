#pragma once

#include "meshing/core/sound_scene.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Degrees. Delaunay refinement that ends for any polygon promises angles up to this, arctan 1/√7
/// cut to three digits (Ruppert 1995; Chew 1993).
inline constexpr double delaunay_angle = 20.7;

/// What a refined mesh is to be like.
struct PlanarMeshOptions {
  double max_length = 0;                ///< no edge longer than this, in scene units; 0: no limit
  double min_angle = delaunay_angle;    ///< degrees, in [0, delaunay_angle]; input angles below it
                                        ///< are left as they are
  std::size_t max_triangles = 1000000;  ///< refinement stops here
};

/// A conforming triangulation in the coordinates of a surface's frame.
struct PlanarMesh {
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
  /// Edges that lie on rings or contact lines, as sorted pairs of points, sorted.
  std::vector<std::array<int, 2>> constrained_edges;
  /// False where refinement ended early or curves had to be left out.
  bool complete = true;
};

/// The constrained Delaunay triangulation of a polygon with holes, without further points except
/// where contact lines cross.
PlanarMesh triangulate(std::span<const Ring> rings, std::span<const Segment2> contacts);

}  // namespace halfshade
