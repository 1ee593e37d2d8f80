#include "solver/reflected/reflected_cost.h"

#include <cmath>

namespace halfshade {

ReflectedCost reflected_cost(int surfaces, const ReflectedOptions& options) {
  // Both ways need more elements where there is more furniture. With weights, few elements matter,
  // but noise of rays is everywhere.
  constexpr double with_weights = 10;
  const double finer = (options.weight ? with_weights : 1) * usual_error / options.tolerance;
  const double rows = 6 * (usual_elements + 8 * surfaces) * std::pow(finer, 2. / 3) * 1.5 + 1500;
  const double by_parts = rows * 3.4e-6 * std::pow(surfaces, 1.25);
  const double by_rays = 1.1 * std::pow(finer, 2.5) * (1 + surfaces / 50.);
  const bool is_exact =
      options.visibility == ReflectedVisibility::exact ||
      (options.visibility == ReflectedVisibility::automatic && by_parts < by_rays);
  return {is_exact, is_exact ? by_parts : by_rays};
}

}  // namespace halfshade
