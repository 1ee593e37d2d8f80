#pragma once

#include "solver/reflected/reflected_light.h"

#include <cmath>

namespace halfshade {

/// With these many elements of order 2 plain rooms come to this error.
inline constexpr double usual_elements = 200, usual_error = 0.01;

/// When one way is given up for the other.
struct GiveUp {
  /// Rays: where they find that light, and so their noise, is amplified by so much.
  double amplified = HUGE_VAL;
  bool stagnant = false;  ///< exactly visible parts: where more elements do not help
};

/// About what reflected light will take.
struct ReflectedCost {
  bool is_exact = false;   ///< by exactly visible parts, or by rays over hemispheres
  GiveUp give_up;          ///< never where one way is asked for
  double cpu_seconds = 0;  ///< within five times that in rooms of 9 to 1,700 surfaces
};

/// The way that the options ask for, or exactly visible parts unless rays are expected to take
/// clearly less time. `surfaces`: of the scene, where options.counted does not say which of them
/// count.
ReflectedCost reflected_cost(int surfaces, const ReflectedOptions& options);

}  // namespace halfshade
