#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstdint>

namespace halfshade {

/// Places in a square that fill it evenly, however many are drawn (Roberts 2018).
class SpreadPairs {
 public:
  explicit SpreadPairs(std::uint64_t seed);
  std::array<double, 2> next();

 private:
  double s_, t_;
};

/// Evenly over a triangle, for s and t in [0, 1].
Vec3 point_of(const std::array<Vec3, 3>& triangle, double s, double t);

}  // namespace halfshade
