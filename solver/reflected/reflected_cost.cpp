#include "solver/reflected/reflected_cost.h"

#include <algorithm>
#include <cmath>

namespace halfshade {

ReflectedCost reflected_cost(int surfaces, const ReflectedOptions& options) {
  if (!options.counted.empty())
    surfaces = static_cast<int>(std::ranges::count(options.counted, true));
  // Both ways need more elements where there is more furniture. With weights, few elements matter,
  // but noise of rays is everywhere.
  constexpr double with_weights = 10;
  const double finer = (options.weight ? with_weights : 1) * usual_error / options.tolerance;
  const double rows = 6 * (usual_elements + 8 * surfaces) * std::pow(finer, 2. / 3) * 1.5 + 1500;
  const double by_parts = rows * 6.8e-6 * std::pow(surfaces, 1.25);
  const double by_rays = 0.21 * std::pow(finer, 2.3) * (1 + surfaces / 15.);
  // What has no noise is worth more time, but not much.
  constexpr double worth = 2.5, most_seconds_more = 2, much_amplified = 4;
  const double worth_waiting = by_rays + std::min((worth - 1) * by_rays, most_seconds_more);
  const bool is_exact =
      options.visibility == ReflectedVisibility::exact ||
      (options.visibility == ReflectedVisibility::automatic && by_parts < worth_waiting);
  GiveUp give_up;
  if (options.visibility == ReflectedVisibility::automatic) {
    constexpr double affordable = 20;  // CPU seconds
    give_up.stagnant = is_exact && by_rays < affordable;
    if (!is_exact) give_up.amplified = std::max(much_amplified, by_parts / worth_waiting);
  }
  return {is_exact, give_up, is_exact ? by_parts : by_rays};
}

}  // namespace halfshade
