#include "solver/pipeline/result_error.h"

#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"

#include <fmt/format.h>

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

std::string error_instead(double error, const std::string& of_what, double tolerance) {
  constexpr int usual_digits = 2, most_digits = 6;
  int digits = usual_digits;
  const auto text = [&](double x) { return fmt::format("{:.{}g}", x, digits); };
  while (digits < most_digits && text(error) == text(tolerance)) ++digits;
  return fmt::format("{} of {} instead of {}", text(error), of_what, text(tolerance));
}

}  // namespace halfshade
