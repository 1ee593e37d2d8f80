#include "solver/reflected/balance_estimate.h"

#include "solver/reflected/loss_balance.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Elements along a border for each of the smallest there.
constexpr double graded = 3;
/// What the solver sees of its amplification may be so many times too little.
constexpr double surely = 3;
constexpr double residual_of_balance = 0.02;

/// As light gets lost, less is there to get lost.
Rgb at_most(const Rgb& lost, const Rgb& there) {
  const Rgb off = lost.abs(), most = there.abs();
  return (off > 0).select(off * most / (off + most), 0);
}

/// ∫ |error|², weighted, if what counts as closed loses light through its gaps.
double lost_in_gaps(const ReflectedSystem& system, const ElementField& there,
                    const std::vector<double>& weight) {
  const auto& [mesh, light, exchange, systems] = system;
  double square = 0;
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const double gaps = systems.gaps[s];
    if (!(gaps > 0)) continue;
    const Rgb lost = (gaps / systems.absorption.row(s).transpose()).min(1);
    square += mesh.area(e) * weight[at(e)] * (lost * there.of(e).row(0).transpose()).square().sum();
  }
  return square;
}

}  // namespace

BalanceEstimate estimate_balance(const ReflectedSystem& system, const ElementField& first_leaving,
                                 const SplitIrradiance& irradiance,
                                 const std::vector<UnsureLoss>& unsure,
                                 const std::vector<double>& weight, double amplification,
                                 double negligible) {
  const auto& [mesh, light, exchange, systems] = system;
  BalanceEstimate estimate;
  estimate.of_element.resize(at(mesh.count()), 0);
  ElementField lost = zero_field(mesh);
  double heaviest = 0;
  for (int e = 0; e < mesh.count(); ++e) {
    const Rgb arriving = irradiance.rest.of(e).row(0).transpose();
    const Rgb leaving = first_leaving.of(e).row(0).transpose() + light.mean_rho(mesh, e) * arriving;
    lost.of(e).row(0) = (unsure[at(e)].factor * leaving.abs()).transpose();
    estimate.square += mesh.area(e) * lost.of(e).row(0).square().sum();
    heaviest = std::max(heaviest, weight[at(e)]);
  }
  estimate.square *= heaviest * std::pow(surely * amplification, 2);
  if (!std::isfinite(estimate.square)) {
    estimate.square = HUGE_VAL;
    return estimate;
  }
  const ElementField there = irradiance.whole(mesh, systems);
  estimate.in_gaps = lost_in_gaps(system, there, weight);
  if (estimate.square <= negligible) {
    estimate.square += estimate.in_gaps;
    return estimate;
  }
  ElementField missing = all_light_of(system, lost, residual_of_balance);
  balance_missing(system, irradiance.rest, unsure, lost, missing);
  estimate.square = estimate.in_gaps;
  double most = 0;
  for (int e = 0; e < mesh.count(); ++e) {
    const Rgb error = at_most(missing.of(e).row(0).transpose(), there.of(e).row(0).transpose());
    const double share = mesh.area(e) * weight[at(e)];
    estimate.square += share * error.square().sum();
    estimate.of_element[at(e)] = share * (error * lost.of(e).row(0).transpose()).sum();
    most = std::max(most, estimate.of_element[at(e)]);
  }
  constexpr double much = 0.1;  // of the most that one matters
  for (int e = 0; e < mesh.count(); ++e) {
    if (estimate.of_element[at(e)] <= much * most)
      estimate.of_element[at(e)] = 0;
    else
      estimate.elements += graded * unsure[at(e)].parts;
  }
  return estimate;
}

ReflectionEstimate reflected_within(ReflectionEstimate estimate,
                                    const std::vector<UnsureLoss>& unsure) {
  for (std::size_t e = 0; e < unsure.size(); ++e) {
    const double more = (std::pow(unsure[e].within, 2) - 1) * estimate.square_error[e];
    estimate.square_error[e] += more;
    estimate.sum += more;
  }
  return estimate;
}

}  // namespace halfshade
