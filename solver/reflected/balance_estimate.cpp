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
constexpr double rough = 0.02;  // residual of what is only an estimate

/// All that is missing where some does, by reflection.
ElementField missing_light(const ReflectedSystem& system, const ElementField& some) {
  return solve_reflected(system, some, ChannelArray::Zero(system.systems.count(), 3), rough)
      .irradiance.whole(system.mesh, system.systems);
}

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
  ElementField missing = missing_light(system, lost);
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

double ReflectedOn::at_most() const {
  return std::pow(std::sqrt(std::max(square, 0.)) + 2 * std::sqrt(variance), 2);
}

namespace {

/// All channels alike: one of them is solved for.
bool is_grey(const ReflectedSystem& system) {
  const auto& [mesh, light, exchange, systems] = system;
  const auto is_even = [](const Rgb& x) { return (x == x[0]).all(); };
  for (int e = 0; e < mesh.count(); ++e) {
    const int root = mesh.root(e);
    if (light.painted.is_painted(root) || !is_even(light.rho[at(root)]) ||
        !is_even(light.exitance[at(root)]))
      return false;
  }
  return true;
}

/// What comes of what points find missing, beside that itself; `missing(e, c)` of an element in a
/// channel.
template <class Missing>
ElementField comes_of(const Missing& missing, const ReflectedSystem& system,
                      const ElementField& irradiance, const ReflectionEstimate& estimate,
                      const std::vector<UnsureLoss>& unsure) {
  const ReflectedMesh& mesh = system.mesh;
  ElementField source = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e)
    if (const double reach = estimate.reach[at(e)]; reach > 0)
      for (int c = 0; c < 3; ++c)
        source.of(e)(0, c) = missing(e, c) * estimate.probed[at(e)] / (reach * mesh.area(e));
  ElementField all = missing_light(system, source);
  balance_change(system, irradiance, unsure, all);
  all.coefficients -= source.coefficients;
  return all;
}

/// The same of all points together, or of each part of them.
std::vector<ElementField> reflected_parts(const ReflectedSystem& system,
                                          const ElementField& irradiance,
                                          const ReflectionEstimate& estimate,
                                          const std::vector<UnsureLoss>& unsure, PointParts which) {
  const auto come_of = [&](const auto& missing) {
    return comes_of(missing, system, irradiance, estimate, unsure);
  };
  if (which == PointParts::one)
    return {come_of([&](int e, int c) {
      double mean = 0;
      for (const Rgb& part : estimate.missing[at(e)]) mean += part[c] / parts_of_probes;
      return mean;
    })};
  const bool is_one_a_channel = is_grey(system);
  const std::size_t at_once = is_one_a_channel ? 3 : 1;
  static_assert(parts_of_probes % 3 == 0);
  std::vector<ElementField> parts;
  for (std::size_t p = 0; p < parts_of_probes; p += at_once) {
    const ElementField all = come_of(
        [&](int e, int c) { return estimate.missing[at(e)][is_one_a_channel ? p + at(c) : p][c]; });
    for (std::size_t k = 0; k < at_once; ++k) {
      parts.push_back(all);
      if (is_one_a_channel)
        for (int c = 0; c < 3; ++c)
          parts.back().coefficients.col(c) = all.coefficients.col(static_cast<Eigen::Index>(k));
    }
  }
  return parts;
}

}  // namespace

ReflectedOn reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                         const ReflectionEstimate& estimate, const std::vector<UnsureLoss>& unsure,
                         const std::vector<double>& weight, PointParts which) {
  const ReflectedMesh& mesh = system.mesh;
  const std::vector<ElementField> parts =
      reflected_parts(system, irradiance.rest, estimate, unsure, which);
  const ElementField there = irradiance.whole(mesh, system.systems);
  const auto n = static_cast<double>(parts.size());
  ReflectedOn on;
  for (int e = 0; e < mesh.count(); ++e) {
    Rgb mean = Rgb::Zero(), variance = Rgb::Zero();
    for (const ElementField& part : parts) mean += part.of(e).row(0).transpose() / n;
    for (const ElementField& part : parts)
      if (n > 1) variance += (part.of(e).row(0).transpose() - mean).square() / (n * (n - 1));
    const Rgb all = there.of(e).row(0).transpose();
    const double share = mesh.area(e) * weight[at(e)];
    on.square += share * at_most(mean, all).square().sum();
    on.variance += share * at_most(variance.sqrt(), all).square().sum();
  }
  on.square -= on.variance;
  return on;
}

}  // namespace halfshade
