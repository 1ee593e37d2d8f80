#include "solver/reflected/balance_estimate.h"

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
  if (estimate.square <= negligible) return estimate;
  const ElementField missing = missing_light(system, lost);
  const ElementField there = irradiance.whole(mesh, systems);
  estimate.square = 0;
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

double square_reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                           const ReflectionEstimate& estimate, const std::vector<double>& weight) {
  const ReflectedMesh& mesh = system.mesh;
  const auto surface_of = [&](int e) { return at(system.light.surface[at(mesh.root(e))]); };
  std::vector<Rgb> mean(1 + at(*std::ranges::max_element(system.light.surface)), Rgb::Zero());
  std::vector<double> reach(mean.size(), 0);
  for (int e = 0; e < mesh.count(); ++e) {
    mean[surface_of(e)] += estimate.missing[at(e)];
    reach[surface_of(e)] += estimate.reach[at(e)];
  }
  ElementField source = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e)
    if (const double there = reach[surface_of(e)]; there > 0)
      source.of(e).row(0) = (mean[surface_of(e)] / there).transpose();
  const ElementField all = missing_light(system, source);
  const ElementField there = irradiance.whole(mesh, system.systems);
  double square = 0;
  for (int e = 0; e < mesh.count(); ++e)
    square += mesh.area(e) * weight[at(e)] *
              at_most((all.of(e).row(0) - source.of(e).row(0)).transpose(),
                      there.of(e).row(0).transpose())
                  .square()
                  .sum();
  return square;
}

void add_unsure_by_rays(const ReflectedSystem& system, const std::vector<double>& rays,
                        std::vector<UnsureLoss>& unsure) {
  const auto& [mesh, light, exchange, systems] = system;
  constexpr double rule_of_three = 3;
  std::vector<double> cast(at(systems.count()), 0);
  for (int e = 0; e < mesh.count(); ++e)
    cast[at(systems.of_element[at(e)])] +=
        rays[at(e)] *
        static_cast<double>(element_nodes_of(mesh.order[at(mesh.triangle[at(e)])]).places.size());
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    if (!systems.closed[at(s)]) unsure[at(e)].factor += rule_of_three / cast[at(s)];
  }
}

}  // namespace halfshade
