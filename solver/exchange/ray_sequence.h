#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstdint>

namespace halfshade {

/// Points of the unit cube in four dimensions, evenly spread for any number of them: two for where
/// a ray begins, two for where it goes.
class RaySequence {
 public:
  /// Seeds give sequences that differ by a shift only.
  explicit RaySequence(std::uint64_t seed);

  /// The k-th point, each coordinate in [0, 1).
  std::array<double, 4> operator[](int k) const;

 private:
  std::array<double, 4> start_;
};

/// Maps the unit square to the triangle, area to area.
Vec3 point_on(const std::array<Vec3, 3>& triangle, double u, double v);

}  // namespace halfshade
