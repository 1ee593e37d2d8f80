#include "solver/linear/two_levels.h"

#include <Eigen/IterativeLinearSolvers>

#include <algorithm>

namespace halfshade {
namespace {

using Sparse = PatchFactors;

/// Means over the elements of each patch.
Sparse averaging(const TwoLevels& levels) {
  const auto patches = levels.factors.cols();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(patches);
  const int count = static_cast<int>(levels.area.size());
  for (int e = 0; e < count; ++e) area[levels.patch_of[at(e)]] += levels.area[at(e)];
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < count; ++e) {
    const int p = levels.patch_of[at(e)];
    entries.emplace_back(p, e, levels.area[at(e)] / area[p]);
  }
  Sparse mean(patches, count);
  mean.setFromTriplets(entries.begin(), entries.end());
  return mean;
}

/// R = ρ (direct + C R) for the patches, C their form factors.
struct PatchSystem {
  const Sparse& C;
  Eigen::VectorXd rho, first;  ///< first = ρ direct
};

Eigen::VectorXd bounced(const PatchSystem& system, int bounces) {
  Eigen::VectorXd R = Eigen::VectorXd::Zero(system.first.size());
  for (int k = 0; k < bounces; ++k)
    R = (system.first + system.rho.cwiseProduct(system.C * R)).eval();
  return R;
}

Eigen::VectorXd solved(const PatchSystem& system, const RadiosityOptions& options,
                       ChannelReport& report) {
  Sparse identity(system.C.rows(), system.C.rows());
  identity.setIdentity();
  const Sparse matrix = identity - system.rho.asDiagonal() * system.C;
  Eigen::BiCGSTAB<Sparse> solver(matrix);
  solver.setTolerance(options.tolerance);
  solver.setMaxIterations(options.max_iterations);
  const Eigen::VectorXd R = solver.solve(system.first);
  report.iterations = static_cast<int>(solver.iterations());
  report.residual = solver.error();
  report.history = {report.residual};
  // Nothing in the inverse is negative, so that its norm is what it makes of ones.
  const Eigen::VectorXd left = system.first - matrix * R;
  const Eigen::VectorXd of_ones = solver.solve(Eigen::VectorXd::Ones(R.size()));
  const double largest = R.cwiseAbs().maxCoeff();
  if (largest > 0)
    report.error = of_ones.cwiseAbs().maxCoeff() * left.cwiseAbs().maxCoeff() / largest;
  return R;
}

}  // namespace

Solution solve_two_levels(const TwoLevels& levels, const ChannelArray& rho,
                          const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                          const RadiosityOptions& options, RadiosityReport& report) {
  const Sparse mean = averaging(levels), C = mean * levels.factors;
  const Sparse& F = levels.factors;
  Solution solution{rho, exitance, {}, {}, direct_irradiance, {}, {}, {}, {}};
  if (direct_irradiance.rows() == 0)
    solution.direct_irradiance = (F * (mean * exitance.matrix()).eval()).array();
  solution.irradiance = solution.direct_irradiance;
  report.converged = true;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::VectorXd of_patch = mean * rho.matrix().col(c);
    const Eigen::VectorXd direct = mean * solution.direct_irradiance.matrix().col(c);
    const PatchSystem system{C, of_patch, of_patch.cwiseProduct(direct)};
    if ((system.first.array() == 0).all()) continue;
    ChannelReport& channel = report.channel[static_cast<std::size_t>(c)];
    const Eigen::VectorXd R =
        options.bounces >= 0 ? bounced(system, options.bounces) : solved(system, options, channel);
    if (options.bounces < 0 && !(channel.residual <= 10 * options.tolerance))
      report.converged = false;
    solution.irradiance.col(c) += (F * R).array();
  }
  solution.radiosity = exitance + rho * solution.irradiance;
  return solution;
}

}  // namespace halfshade
