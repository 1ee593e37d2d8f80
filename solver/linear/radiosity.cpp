#include "solver/linear/radiosity.h"

#include "meshing/core/error.h"
#include "solver/exchange/scaled_operator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// The residual is computed anew in the end; rounding may make it this many times the iteration's.
constexpr double residual_slack = 10;

/// One channel of the problem.
struct Channel {
  Eigen::VectorXd rho, exitance, direct_irradiance;
};

struct ChannelSolution {
  Eigen::VectorXd radiosity, irradiance;
  Eigen::VectorXd reflected;  ///< what the irradiance was gathered from
};

Eigen::VectorXd irradiance_from(const Exchange& exchange, const Eigen::VectorXd& B) {
  return (multiply(exchange.matrix, B).array() / exchange.area).matrix();
}

/// In a closed enclosure where nothing absorbs, light that is put in never gets out.
void require_somewhere_to_go(const Exchange& exchange, const Channel& channel) {
  const Enclosures& enclosures = exchange.enclosures;
  std::vector<bool> absorbs(enclosures.closed.size());
  std::vector<double> emitted(enclosures.closed.size());
  for (std::size_t e = 0; e < enclosures.of_element.size(); ++e) {
    const auto k = static_cast<std::size_t>(enclosures.of_element[e]);
    const auto row = static_cast<Eigen::Index>(e);
    absorbs[k] = absorbs[k] || channel.rho[row] < 1;
    emitted[k] += exchange.area[row] * channel.exitance[row];
  }
  for (std::size_t k = 0; k < absorbs.size(); ++k)
    if (enclosures.closed[k] && !absorbs[k] && emitted[k] > 0)
      throw Error(
          ErrorCode::invalid_input, "solve_radiosity",
          fmt::format(
              "a closed enclosure reflects everything (reflectance 1) and emits {} W, so its "
              "radiosity has no limit; lower a reflectance",
              emitted[k]));
}

ChannelSolution sum_bounces(const Exchange& exchange, const Channel& channel, int bounces) {
  const Eigen::VectorXd dark = Eigen::VectorXd::Zero(channel.rho.size());
  ChannelSolution solution{channel.exitance, dark, dark};
  for (int bounce = 0; bounce < bounces; ++bounce) {
    solution.reflected = solution.radiosity - channel.exitance;
    solution.irradiance = channel.direct_irradiance + irradiance_from(exchange, solution.reflected);
    solution.radiosity = channel.exitance + channel.rho.cwiseProduct(solution.irradiance);
  }
  return solution;
}

/// The best uniform reflected radiosity, in the scaled unknown: the ambient term of progressive
/// refinement (Cohen et al. 1988). It takes the one slow mode of a bright enclosure out of the
/// iteration.
Eigen::VectorXd ambient_guess(const Channel& channel, const ScaledOperator& matrix,
                              const Eigen::VectorXd& scale, const Eigen::VectorXd& b) {
  const Eigen::VectorXd uniform =
      (channel.rho.array() > 0).select(scale.cwiseInverse(), Eigen::VectorXd::Zero(b.size()));
  const double energy = uniform.dot(matrix.apply(uniform));
  if (!(energy > 0)) return Eigen::VectorXd::Zero(b.size());
  return uniform.dot(b) / energy * uniform;
}

ChannelSolution solve_channel(const Exchange& exchange, const Channel& channel,
                              const RadiosityOptions& options, ChannelReport& report) {
  // (A/rho − M) B = A E/rho for rho > 0, scaled by its diagonal: y = √(A/rho) B.
  const Eigen::VectorXd scale = (channel.rho.array() / exchange.area).sqrt().matrix();
  ChannelSolution solution;
  // The light of black elements goes to the right-hand side; solving for the reflected part R = B −
  // E instead of B does that for all elements at once: (A/rho − M) R = M E.
  const Eigen::VectorXd b =
      scale.cwiseProduct((channel.direct_irradiance.array() * exchange.area).matrix());
  const ScaledOperator matrix(exchange.matrix, scale, -1);
  ConjugateGradients cg(matrix);
  cg.setTolerance(options.tolerance);
  cg.setMaxIterations(options.max_iterations);
  const Eigen::VectorXd y = cg.solveWithGuess(b, ambient_guess(channel, matrix, scale, b));
  report.iterations = static_cast<int>(cg.iterations());
  report.residual = b.norm() > 0 ? (b - matrix.apply(y)).norm() / b.norm() : 0;
  // Rounding may leave the reflected part of an unlit element a hair below zero.
  solution.reflected = scale.cwiseProduct(y).cwiseMax(0.);
  solution.irradiance = channel.direct_irradiance + irradiance_from(exchange, solution.reflected);
  solution.radiosity = channel.exitance + channel.rho.cwiseProduct(solution.irradiance);
  return solution;
}

void balance_power(const Exchange& exchange, const Channel& channel,
                   const ChannelSolution& solution, ChannelReport& report) {
  const Eigen::ArrayXd& area = exchange.area;
  const Eigen::ArrayXd sees = multiply(exchange.matrix, Eigen::VectorXd::Ones(area.size())).array();
  report.emitted_power = (area * channel.exitance.array()).sum();
  report.absorbed_power = (area * (1 - channel.rho.array()) * solution.irradiance.array()).sum();
  report.escaped_power = report.emitted_power - (area * channel.direct_irradiance.array()).sum() +
                         ((solution.radiosity - channel.exitance).array() * (area - sees)).sum();
  report.balance =
      report.emitted_power > 0
          ? std::abs(report.emitted_power - report.absorbed_power - report.escaped_power) /
                report.emitted_power
          : 0;
}

bool is_grey(const ChannelArray& values) {
  return (values.col(0) == values.col(1)).all() && (values.col(0) == values.col(2)).all();
}

}  // namespace

Solution solve_radiosity(const Exchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress) {
  report = {};
  report.channels = is_grey(rho) && is_grey(exitance) ? 1 : 3;
  const ChannelArray dark = ChannelArray::Zero(rho.rows(), 3);
  Solution solution{rho, exitance, dark, dark, dark, {}, {}};
  for (int c = 0; c < report.channels; ++c) {
    progress("radiosity", c / static_cast<double>(report.channels));
    Channel channel{rho.col(c).matrix(), exitance.col(c).matrix(), {}};
    channel.direct_irradiance = direct_irradiance.rows() > 0
                                    ? Eigen::VectorXd(direct_irradiance.col(c))
                                    : irradiance_from(exchange, channel.exitance);
    ChannelReport& channel_report = report.channel[static_cast<std::size_t>(c)];
    report.unknowns =
        std::max(report.unknowns, static_cast<int>((channel.rho.array() > 0).count()));
    ChannelSolution part;
    if (options.bounces >= 0) {
      part = sum_bounces(exchange, channel, options.bounces);
      channel_report.iterations = options.bounces;
    } else {
      require_somewhere_to_go(exchange, channel);
      part = solve_channel(exchange, channel, options, channel_report);
      report.converged =
          report.converged && channel_report.residual <= residual_slack * options.tolerance;
    }
    balance_power(exchange, channel, part, channel_report);
    solution.radiosity.col(c) = part.radiosity.array();
    solution.irradiance.col(c) = part.irradiance.array();
    solution.direct_irradiance.col(c) = channel.direct_irradiance.array();
  }
  for (int c = report.channels; c < 3; ++c) {
    report.channel[static_cast<std::size_t>(c)] = report.channel[0];
    solution.radiosity.col(c) = solution.radiosity.col(0);
    solution.irradiance.col(c) = solution.irradiance.col(0);
    solution.direct_irradiance.col(c) = solution.direct_irradiance.col(0);
  }
  return solution;
}

}  // namespace halfshade
