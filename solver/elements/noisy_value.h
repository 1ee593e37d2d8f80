#pragma once

#include "meshing/core/types.h"

namespace halfshade {

/// What is known of a value by chance: two estimates, each right but for noise of its own, so that
/// the product of what they are off is, in the mean, the square of their common error.
struct NoisyValue {
  Rgb a = Rgb::Zero(), b = Rgb::Zero();

  Rgb mean() const { return 0.5 * (a + b); }
  /// Variance of the mean, as the two have it; the channels' summed, as the next.
  double noise() const { return (a - b).square().sum() / 4; }
  /// Of the value, without bias by noise; may be negative.
  double square() const { return (a * b).sum(); }
};

}  // namespace halfshade
