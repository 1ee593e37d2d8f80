#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cmath>

namespace halfshade {

/// Planes that a box is compared with at a time; with normals of zero where there are fewer.
struct FourPlanes {
  using Four = Eigen::Array4d;
  std::array<Four, 3> normal = {Four::Zero(), Four::Zero(), Four::Zero()};  ///< [axis] unit length
  std::array<Four, 3> span = normal;  ///< their absolute values
  Four limit = Four::Zero();          ///< normal · x in the planes

  void set(std::size_t which, const Vec3& out, double limit_there) {
    const auto lane = static_cast<Eigen::Index>(which);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      normal[axis][lane] = out[static_cast<Eigen::Index>(axis)];
      span[axis][lane] = std::abs(normal[axis][lane]);
    }
    limit[lane] = limit_there;
  }

  /// How far above each plane the lowest corner of a box lies.
  Four lowest(const Vec3& centre, const Vec3& half) const {
    return normal[0] * centre[0] + normal[1] * centre[1] + normal[2] * centre[2] -
           span[0] * half[0] - span[1] * half[1] - span[2] * half[2] - limit;
  }
};

}  // namespace halfshade
