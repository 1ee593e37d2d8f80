#pragma once

#include "meshing/core/types.h"

#include <span>

namespace halfshade {

/// How finely coordinates are written: what their file rounded them to.
struct WrittenDigits {
  int most = 0;           ///< significant digits of the longest one
  int last_place = 999;   ///< the finest place that one of them has: a power of ten
  bool is_single = true;  ///< all are numbers of single precision, or nine digits of them
};

WrittenDigits digits_of(std::span<const Vec3> points);

/// By how much a coordinate of a magnitude may be off: half of its last place, be it that all have
/// as many decimals or as many digits.
double rounding_of(double magnitude, const WrittenDigits& digits);

/// How far apart, along their normal, the rounding of the coordinates of two polygons can have
/// brought planes that were one. What digits the file had is seen at both. A coordinate that is the
/// same at all corners of each is not off: rounding does not part equal numbers, so that a gap
/// along an axis is one, however few digits tell of it.
double rounding_between(std::span<const Vec3> a, std::span<const Vec3> b, const Vec3& normal);

/// The same of two polygons like this one. Of fewer digits than five it is not known that more were
/// rounded: it counts as five, then.
double rounding_of_plane(std::span<const Vec3> corners, const Vec3& normal);

}  // namespace halfshade
