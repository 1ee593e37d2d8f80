#pragma once

#include "meshing/core/plane_frame.h"

#include <cmath>
#include <numbers>

namespace halfshade {

/// A direction away from the frame's plane, along its normal for s = 0. Two numbers that are evenly
/// spread from 0 to 1 make directions with a density of cos θ / π: what is even in the disk below
/// the hemisphere is so on it (Malley, 1988).
inline Vec3 cosine_direction(const PlaneFrame& frame, double s, double t) {
  const double radius = std::sqrt(s), turn = 2 * std::numbers::pi * t;
  return radius * (std::cos(turn) * frame.e1 + std::sin(turn) * frame.e2) +
         std::sqrt(1 - s) * frame.normal;
}

}  // namespace halfshade
