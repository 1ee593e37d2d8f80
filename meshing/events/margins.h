#pragma once

#include "meshing/geometry/line.h"

#include <algorithm>
#include <limits>

/// What counts as rounding where events are enumerated.
namespace halfshade::margins {

/// Lines with a smaller sine between them are parallel, and have no point in common; those with a
/// smaller sine to the emitter do not come from it. A thousand times what rounding makes of equal
/// ones.
inline constexpr double parallel_sine = 1e-12;

/// Lines that run along a face to within this sine may have it on either side; planes that meet at
/// a smaller one have no line in common that is worth following. Far above what the repair leaves.
inline constexpr double grazing_sine = 1e-9;

/// Positions agree to this many roundings of the largest coordinate.
inline constexpr double position_roundings = 1e4;

/// Positions near p closer than this are the same: a length.
inline double slack_at(const Vec3& p) {
  return position_roundings * std::numeric_limits<double>::epsilon() * p.lpNorm<Eigen::Infinity>();
}
inline double slack_of(const Span3& span) {
  return std::max(slack_at(span.from), slack_at(span.to));
}

/// Share of an edge by which a line may miss its ends and still meet it.
inline constexpr double edge_margin = 1e-10;

/// Bound for the relative error of a sum of three 3 × 3 determinants of rounded differences.
inline constexpr double determinant_error = 32 * std::numeric_limits<double>::epsilon();

/// Relative error of a discriminant that was computed from rounded coefficients.
inline constexpr double discriminant_error = 4 * std::numeric_limits<double>::epsilon();

}  // namespace halfshade::margins
