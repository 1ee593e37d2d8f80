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

}  // namespace halfshade
