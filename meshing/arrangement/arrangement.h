#pragma once

#include "meshing/core/types.h"
#include "meshing/geometry/link.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Segments of a plane, split wherever they meet.
struct Arrangement {
  std::vector<Vec2> points;              ///< the given ones first, then crossings
  std::vector<std::vector<int>> chains;  ///< one a segment: the points it runs through, in order
};

/// What counts as meeting. Both must exceed the rounding of the coordinates by far, which makes
/// every decision below safe in double precision.
struct SnapRadii {
  double points = 0;  ///< points closer together than this are one point
  double links = 0;   ///< links pass through points closer to them than this; at least `points`
};

/// Splits segments (pairs of points) where they cross and where a point lies near them, and
/// replaces points close together by the one that comes first. Afterwards links of chains meet at
/// common points only, and no point lies near a link it does not end, save where the link would
/// have to grow to reach it (Hobby 1999 without the grid). Deterministic; points keep their
/// coordinates.
///
/// SnapGraph does not serve here, nor this there: it holds some edges where they are, lets others
/// pass beside points from snap/3 onwards and moves the ends of lines, to bound how small the
/// triangles between them get. Here all segments count alike and no point moves, the radii are the
/// caller's own (in repair a thousand times apart), and nothing but meeting matters.
Arrangement arrange(std::vector<Vec2> points, std::span<const std::array<int, 2>> segments,
                    const SnapRadii& snap);

/// A triangulation of a convex hull.
struct HullTriangulation {
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
  std::vector<std::array<int, 3>> neighbours;  ///< [k]: across the edge from corner k to k+1; or −1
};

/// The constrained Delaunay triangulation of links that meet at common points only, over the points
/// they join. Throws Error(invalid_input) if links cross after all.
HullTriangulation constrained_delaunay(std::span<const Vec2> points,
                                       std::span<const std::array<int, 2>> links);

}  // namespace halfshade
