#pragma once

#include "meshing/core/sound_scene.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Cuts a polygon with holes into triangles between its own corners, counter-clockwise. Corners are
/// numbered through all rings, one ring after the other; where several lie in one place the
/// triangles share the first. Triangles and clearly convex quadrilaterals are cut from their first
/// corner, others by constrained Delaunay triangulation. What blocks light is cut by this alone, so
/// that visibility by rays and by backprojection knows the same triangles. Empty for a single ring
/// of less than three corners.
std::vector<std::array<int, 3>> ring_triangles(std::span<const Ring> rings);

}  // namespace halfshade
