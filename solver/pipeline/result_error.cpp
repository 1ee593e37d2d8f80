#include "solver/pipeline/result_error.h"

#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"

#include <algorithm>

namespace halfshade {

double error_of_elements_and_solver(const SolveResult& result) {
  const Solution& solution = result.solution;
  // Squares of light of any size must not over- or underflow.
  const double scale = balancing_scale(solution.irradiance.maxCoeff());
  const ChannelArray irradiance = scale * solution.irradiance;
  const Eigen::ArrayXd estimate = scale * solution.error_estimate;
  double of_solver = 0;
  for (const ChannelReport& channel : result.radiosity.channel)
    of_solver = std::max(of_solver, channel.error);
  return relative_error(result.elements, irradiance, estimate) + of_solver;
}

}  // namespace halfshade
