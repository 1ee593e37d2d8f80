#include "solver/elements/balancing_scale.h"

#include <algorithm>
#include <cmath>

namespace halfshade {

double balancing_scale(double largest) {
  if (!(largest > 0)) return 1;
  int exponent = 0;
  std::frexp(largest, &exponent);
  // The inverse must be a double, too.
  return std::ldexp(1., -std::clamp(exponent, -1022, 1022));
}

Rgb balancing_scale(std::span<const Rgb> values) {
  constexpr double weakest = 0x1p-100;  // of the strongest channel, as they are scaled
  Rgb largest = Rgb::Zero();
  for (const Rgb& value : values) largest = largest.max(value);
  Rgb scale = Rgb::Constant(balancing_scale(largest.maxCoeff()));
  for (int k = 0; k < scale.size(); ++k)
    if (largest[k] > 0 && scale[k] * largest[k] < weakest)
      scale[k] = weakest * balancing_scale(largest[k]);
  return scale;
}

}  // namespace halfshade
