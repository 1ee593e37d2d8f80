#pragma once

#include "meshing/core/types.h"

namespace halfshade {

/// What is known of a value by chance: two estimates, each right but for noise of its own, so that
/// the product of what they are off is, in the mean, the square of their common error.
struct NoisyValue {
  Rgb a = Rgb::Zero(), b = Rgb::Zero();

  Rgb mean() const { return 0.5 * (a + b); }
};

}  // namespace halfshade
