#pragma once

#include "solver/reflected/reflected_light.h"

namespace halfshade {

/// With these many elements of order 2 plain rooms come to this error.
inline constexpr double usual_elements = 200, usual_error = 0.01;

/// About what reflected light will take.
struct ReflectedCost {
  bool is_exact = false;   ///< by exactly visible parts, or by rays over hemispheres
  double cpu_seconds = 0;  ///< as measured on rooms of 15 to 560 surfaces; elsewhere a rough guess
};

/// The way that the options ask for, or the one expected to take less time.
ReflectedCost reflected_cost(int surfaces, const ReflectedOptions& options);

}  // namespace halfshade
