#pragma once

#include "meshing/core/types.h"

#include <algorithm>
#include <array>

namespace halfshade {

/// The height of a triangle over its longest side, which is its shortest; 0 of a point.
inline double shortest_height(const std::array<Vec3, 3>& triangle) {
  const Vec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  return longest > 0 ? ab.cross(ac).norm() / longest : 0;
}

}  // namespace halfshade
