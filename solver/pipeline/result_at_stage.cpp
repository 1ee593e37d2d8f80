#include "solver/pipeline/result_at_stage.h"

#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"

#include <utility>

namespace halfshade {

SolveResult result_at_stage(SolveResult result, const RadiosityStage& stage) {
  Solution& solution = result.solution;
  // Squares of light of any size must not over- or underflow.
  const double scale = balancing_scale(solution.irradiance.maxCoeff());
  const ChannelArray change = scale * (solution.irradiance - stage.irradiance);
  const Eigen::ArrayXd to_come = change.square().rowwise().mean().sqrt();
  const double missing = relative_error(result.elements, scale * solution.irradiance, to_come);
  solution.error_estimate += to_come / scale;
  result.relative_error += missing;
  solution.irradiance = stage.irradiance;
  if (stage.power[0].shot + stage.power[1].shot + stage.power[2].shot == 0)
    solution.direct_irradiance.setZero();
  solution.radiosity = solution.exitance + solution.rho * stage.irradiance;
  result.radiosity.stages.clear();
  return result;
}

}  // namespace halfshade
