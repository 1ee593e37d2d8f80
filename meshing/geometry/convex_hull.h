#pragma once

#include "meshing/core/types.h"

#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Indices of the corners of the convex hull of points in a plane, counter-clockwise; points on its
/// sides are none, and of equal points one is. Corners that stand out by no more than rounding may
/// be missing. Precondition: not all points lie on one line. O(n log n) (Andrew 1979).
std::vector<std::size_t> convex_hull(std::span<const Vec2> points);

}  // namespace halfshade
