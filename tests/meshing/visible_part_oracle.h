#pragma once

#include "meshing/visible_part.h"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

/// Independent ways to find what is visible of an emitter.
namespace halfshade::test {

using LongVec = Eigen::Matrix<long double, 3, 1>;

/// Lambert's edge sum over the pieces of a boundary, in extended precision: the form factor.
inline double lambert(std::span<const BoundaryPiece> pieces, const Vec3& point,
                      const Vec3& normal) {
  long double sum = 0;
  for (const BoundaryPiece& piece : pieces) {
    const LongVec a = piece.from.cast<long double>() - point.cast<long double>();
    const LongVec b = piece.to.cast<long double>() - point.cast<long double>();
    const LongVec cross = a.cross(b);
    const long double sine = cross.norm();
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) / sine * normal.cast<long double>().dot(cross);
  }
  return static_cast<double>(-sum / (2 * std::numbers::pi_v<long double>));
}

}  // namespace halfshade::test
