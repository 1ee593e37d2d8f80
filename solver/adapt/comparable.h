#pragma once

#include "meshing/core/rounded.h"

namespace halfshade {

/// A square as a share of another one, to compare it: rounding steps at the same shares in any unit
/// of length. Errors are small differences of large values: those of twins in a symmetric scene are
/// alike to so many digits.
inline double comparable(double square, double of) {
  constexpr int error_digits = 12;
  return rounded<error_digits>(of > 0 ? square / of : square);
}

}  // namespace halfshade
