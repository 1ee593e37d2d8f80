#pragma once

#include "meshing/core/types.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Triangles between the corners of a closed polygon that need not be planar, which it bounds
/// together: of all such triangulations the one whose sharpest fold is flattest, of those the one
/// of least area (Liepa, 2003). Corners as indices, in the order of the polygon. Empty if there is
/// none, as between corners that lie on a line. Cost: cubic in the corners.
std::vector<std::array<int, 3>> triangulate_skew_polygon(std::span<const Vec3> polygon);

}  // namespace halfshade
