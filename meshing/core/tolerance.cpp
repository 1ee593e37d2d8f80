#include "meshing/core/tolerance.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Shares of the magnitude.
constexpr double arithmetic = 0x1p-46;  // what some hundred roundings of doubles come to
constexpr double same_point = 1e-9;
constexpr double six_digits = 1e-6;
// Shares of the size of the thing concerned.
constexpr double least_feature = 1e-6;   // of two points of it
constexpr double least_flatness = 1e-3;  // of how it may be bent

}  // namespace

LocalScale scale_of(std::span<const Vec3> points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()),
          (high - low).stableNorm(), 0};
}

LocalScale joint_scale(const LocalScale& a, const LocalScale& b) {
  return {std::max(a.magnitude, b.magnitude), std::min(a.size, b.size),
          std::max(a.rounding, b.rounding)};
}

LocalTolerance tolerance_of(const LocalScale& scale) {
  LocalTolerance tolerance;
  tolerance.length = std::max(arithmetic * scale.magnitude,
                              std::min(same_point * scale.magnitude, least_feature * scale.size));
  tolerance.planarity =
      std::max(tolerance.length, std::min(std::max(six_digits * scale.magnitude, scale.rounding),
                                          least_flatness * scale.size));
  return tolerance;
}

}  // namespace halfshade
