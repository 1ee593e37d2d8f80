#include "solver/linear/radiosity.h"

#include "meshing/core/error.h"
#include "solver/linear/classic_solvers.h"
#include "solver/linear/combine_stages.h"
#include "solver/linear/system_solver.h"

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
  std::vector<ShotStage> stages;
};

Eigen::VectorXd irradiance_from(const LightExchange& exchange, const Eigen::VectorXd& B) {
  return (exchange.apply_all(B).array() / exchange.area).matrix();
}

ChannelSolution sum_bounces(const LightExchange& exchange, const Channel& channel, int bounces) {
  const Eigen::VectorXd dark = Eigen::VectorXd::Zero(channel.rho.size());
  ChannelSolution solution{channel.exitance, dark, dark, {}};
  for (int bounce = 0; bounce <= bounces; ++bounce) {
    solution.reflected = solution.radiosity - channel.exitance;
    solution.irradiance = channel.direct_irradiance + irradiance_from(exchange, solution.reflected);
    solution.radiosity = channel.exitance + channel.rho.cwiseProduct(solution.irradiance);
  }
  return solution;
}

std::vector<std::vector<int>> elements_of(const Enclosures& systems) {
  std::vector<std::vector<int>> elements(systems.closed.size());
  for (std::size_t e = 0; e < systems.of_element.size(); ++e)
    elements[at(systems.of_element[e])].push_back(static_cast<int>(e));
  return elements;
}

ChannelSolution solve_channel(const LightExchange& exchange, const Channel& channel,
                              const RadiosityOptions& options, ChannelReport& report) {
  ChannelSolution solution;
  solution.reflected = Eigen::VectorXd::Zero(channel.rho.size());
  const std::vector<std::vector<int>> systems = elements_of(exchange.systems);
  const SystemLight light{channel.rho, channel.exitance, channel.direct_irradiance};
  for (std::size_t k = 0; k < systems.size(); ++k) {
    const SystemReport solved = solve_system({exchange, systems[k], static_cast<int>(k)}, light,
                                             options, solution.reflected);
    if (solved.iterations > report.iterations) {
      report.iterations = solved.iterations;
      report.history = solved.history;
    }
    report.residual = std::max(report.residual, solved.residual);
    report.error = std::max(report.error, solved.error);
  }
  // One more exchange makes the light of black elements, and smooths.
  solution.irradiance = channel.direct_irradiance + irradiance_from(exchange, solution.reflected);
  solution.radiosity = channel.exitance + channel.rho.cwiseProduct(solution.irradiance);
  return solution;
}

/// Of the reflected radiosity, relative to it. What is left falls as it fell in the last sweep; in
/// the first ones, after which one was stopped, that is faster than it goes on, and as slow as
/// where nothing gets lost.
double error_of_sweeps(const ReflectionProblem& problem, const Eigen::VectorXd& reflected,
                       const ChannelReport& report, double tolerance) {
  constexpr double slowest = 0.999999;
  const std::size_t n = report.history.size();
  double rate = n > 1 ? report.residual / report.history[n - 2] : 0;
  if (report.residual > tolerance)
    rate = std::max(rate, (problem.area * problem.rho.array()).sum() / problem.area.sum());
  const double first = (problem.area * problem.first.array()).sum(),
               all = (problem.area * reflected.array()).sum();
  return all > 0 ? report.residual / (1 - std::min(rate, slowest)) * (first / all) : 0;
}

/// By the solvers that radiosity began with, all systems at once.
ChannelSolution sweep_channel(const LightExchange& exchange, const Channel& channel,
                              const RadiosityOptions& options, const Progress& progress,
                              ChannelReport& report) {
  if (!exchange.matrix)
    throw Error(ErrorCode::contract, "solve_radiosity", "this solver needs a matrix");
  const ReflectionProblem problem{*exchange.matrix, exchange.area, channel.rho,
                                  channel.rho.cwiseProduct(channel.direct_irradiance)};
  SweepResult swept = sweep(problem, options.solver,
                            {options.tolerance, options.max_sweeps,
                             options.stages && shoots(options.solver), progress.stop});
  report.iterations = swept.sweeps;
  report.history = std::move(swept.history);
  report.residual = swept.residual;
  report.error = error_of_sweeps(problem, swept.reflected, report, options.tolerance);
  ChannelSolution solution;
  solution.stages = std::move(swept.stages);
  solution.reflected = std::move(swept.reflected);
  solution.irradiance = channel.direct_irradiance + irradiance_from(exchange, solution.reflected);
  solution.radiosity = channel.exitance + channel.rho.cwiseProduct(solution.irradiance);
  return solution;
}

void balance_power(const LightExchange& exchange, const Channel& channel,
                   const ChannelSolution& solution, ChannelReport& report) {
  const Eigen::ArrayXd& area = exchange.area;
  report.emitted_power = (area * channel.exitance.array()).sum();
  report.absorbed_power = (area * (1 - channel.rho.array()) * solution.irradiance.array()).sum();
  report.escaped_power = report.emitted_power - (area * channel.direct_irradiance.array()).sum() +
                         ((solution.radiosity - channel.exitance).array() * exchange.lost).sum();
  report.balance =
      report.emitted_power > 0
          ? std::abs(report.emitted_power - report.absorbed_power - report.escaped_power) /
                report.emitted_power
          : 0;
}

void require_finite(const ChannelSolution& solution) {
  if (!solution.radiosity.allFinite() || !solution.irradiance.allFinite())
    throw Error(ErrorCode::invalid_input, {},
                "the radiosity is larger than any number that double precision holds; give the "
                "exitances in another unit");
}

int count_lit(const Enclosures& systems, const ChannelArray& exitance,
              const ChannelArray& direct_irradiance) {
  std::vector<bool> lit(systems.closed.size());
  for (std::size_t e = 0; e < systems.of_element.size(); ++e) {
    const auto row = static_cast<Eigen::Index>(e);
    if ((exitance.row(row) > 0).any() || (direct_irradiance.row(row) > 0).any())
      lit[at(systems.of_element[e])] = true;
  }
  return static_cast<int>(std::count(lit.begin(), lit.end(), true));
}

bool is_grey(const ChannelArray& values) {
  return (values.col(0) == values.col(1)).all() && (values.col(0) == values.col(2)).all();
}

}  // namespace

std::optional<UnlimitedSystem> find_unlimited(const LightExchange& exchange,
                                              const ChannelArray& rho,
                                              const ChannelArray& exitance) {
  const Enclosures& systems = exchange.systems;
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<bool> loses(systems.closed.size());
    std::vector<double> power(systems.closed.size());
    for (std::size_t e = 0; e < systems.of_element.size(); ++e) {
      const auto row = static_cast<Eigen::Index>(e);
      const std::size_t k = at(systems.of_element[e]);
      loses[k] = loses[k] || rho(row, c) < 1 || exchange.lost[row] > 0;
      power[k] += exchange.area[row] * exitance(row, c);
    }
    for (std::size_t k = 0; k < loses.size(); ++k)
      if (!loses[k] && power[k] > 0) return UnlimitedSystem{static_cast<int>(k), power[k]};
  }
  return std::nullopt;
}

Solution solve_radiosity(const Exchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress) {
  return solve_radiosity(light_exchange(exchange), rho, exitance, direct_irradiance, options,
                         report, progress);
}

Solution solve_radiosity(const LightExchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress) {
  report = {};
  report.channels = is_grey(rho) && is_grey(exitance) && !options.all_channels ? 1 : 3;
  const ChannelArray dark = ChannelArray::Zero(rho.rows(), 3);
  Solution solution{rho, exitance, dark, dark, dark, {}, {}, {}, {}};
  std::array<std::vector<ShotStage>, 3> stages;
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
      part = options.solver == RadiositySolver::conjugate_gradients
                 ? solve_channel(exchange, channel, options, channel_report)
                 : sweep_channel(exchange, channel, options, progress, channel_report);
      report.converged =
          report.converged && channel_report.residual <= residual_slack * options.tolerance;
    }
    require_finite(part);
    balance_power(exchange, channel, part, channel_report);
    solution.radiosity.col(c) = part.radiosity.array();
    solution.irradiance.col(c) = part.irradiance.array();
    solution.direct_irradiance.col(c) = channel.direct_irradiance.array();
    stages[static_cast<std::size_t>(c)] = std::move(part.stages);
  }
  for (int c = report.channels; c < 3; ++c) {
    report.channel[static_cast<std::size_t>(c)] = report.channel[0];
    solution.radiosity.col(c) = solution.radiosity.col(0);
    solution.irradiance.col(c) = solution.irradiance.col(0);
    solution.direct_irradiance.col(c) = solution.direct_irradiance.col(0);
  }
  if (options.stages) report.stages = combine_stages(exchange, solution, stages);
  report.systems = count_lit(exchange.systems, exitance, solution.direct_irradiance);
  return solution;
}

}  // namespace halfshade
