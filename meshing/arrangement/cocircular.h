#pragma once

#include "meshing/arrangement/arrangement.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Angle by which a point must lie inside a circle to count as inside: that of a chord seen from
/// the point and from the circle comes to so much more than a half turn, in radians.
inline constexpr double inside_circle = 1e-8;

/// Where points lie on one circle to rounding, all triangulations of them are Delaunay, and exact
/// signs of rounded coordinates choose any of them. Here they get the one that begins at their
/// leftmost point, the highest of several, rounded; and triangles the order of their corners'
/// numbers, each with its lowest first. `constrained` tells edges that stay, [k] from corner k to k
/// + 1.
void settle_ties(std::span<const Vec2> points, const std::vector<std::array<bool, 3>>& constrained,
                 HullTriangulation& hull);

}  // namespace halfshade
