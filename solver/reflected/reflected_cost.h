#pragma once

#include "solver/reflected/reflected_light.h"

#include <cmath>

namespace halfshade {

/// With these many elements of order 2 plain rooms come to this error.
inline constexpr double usual_elements = 200, usual_error = 0.01;

/// About what reflected light will take.
struct ReflectedCost {
  bool is_exact = false;  ///< by exactly visible parts, or by rays over hemispheres
  /// Noise of rays is amplified as light is: from there on exactly visible parts are worth their
  /// time. Never where they are not to be chosen.
  double most_amplified = HUGE_VAL;
  double cpu_seconds = 0;  ///< within five times that in rooms of 9 to 1,700 surfaces
};

/// The way that the options ask for, or exactly visible parts unless rays are expected to take far
/// less time. `surfaces`: of the scene, where options.counted does not say which of them count.
ReflectedCost reflected_cost(int surfaces, const ReflectedOptions& options);

}  // namespace halfshade
