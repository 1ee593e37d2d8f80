#include "solver/elements/solution_parts.h"

namespace halfshade {

Solution solution_of_parts(const Solution& whole, const std::vector<int>& element) {
  Solution solution;
  solution.rho = whole.rho(element, Eigen::all);
  solution.exitance = whole.exitance(element, Eigen::all);
  solution.radiosity = whole.radiosity(element, Eigen::all);
  solution.irradiance = whole.irradiance(element, Eigen::all);
  solution.direct_irradiance = whole.direct_irradiance(element, Eigen::all);
  solution.error_estimate = whole.error_estimate(element);
  if (whole.band_irradiance.rows() > 0) {
    solution.band_radiosity = whole.band_radiosity(element, Eigen::all);
    solution.band_irradiance = whole.band_irradiance(element, Eigen::all);
  }
  for (const int e : element)
    if (!whole.region.empty()) solution.region.push_back(whole.region[at(e)]);
  return solution;
}

}  // namespace halfshade
