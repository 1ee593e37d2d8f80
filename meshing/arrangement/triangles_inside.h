#pragma once

#include "meshing/arrangement/arrangement.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

using Link = std::array<int, 2>;

inline Link sorted_link(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

/// Marks the triangles inside a polygon with holes: those reached from outside the hull over an odd
/// number of `border` links (sorted).
std::vector<bool> triangles_inside(const HullTriangulation& hull, std::span<const Link> border);

}  // namespace halfshade
