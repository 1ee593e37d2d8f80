#include "solver/reflected/balance_estimate.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Elements along a border for each of the smallest there.
constexpr double graded = 3;

}  // namespace

BalanceEstimate estimate_balance(const ReflectedSystem& system, const ElementField& first_leaving,
                                 const ElementField& irradiance,
                                 const std::vector<UnsureLoss>& unsure,
                                 const std::vector<double>& weight) {
  const auto& [mesh, light, exchange, systems] = system;
  ChannelArray put_in = ChannelArray::Zero(systems.count(), 3);
  ChannelArray not_known = put_in, square = put_in;
  std::vector<Rgb> of_element;
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const Rgb first = first_leaving.of(e).row(0).transpose();
    const Rgb arriving = irradiance.of(e).row(0).transpose();
    const Rgb leaving = first + light.mean_rho(mesh, e) * arriving;
    of_element.push_back(mesh.area(e) * unsure[at(e)].factor * leaving.abs());
    put_in.row(s) += mesh.area(e) * first.transpose();
    not_known.row(s) += of_element.back().transpose();
    square.row(s) += mesh.area(e) * weight[at(e)] * irradiance.of(e).square().colwise().sum();
  }
  BalanceEstimate estimate;
  // What gets lost is missing where it would get lost from.
  const ChannelArray relative = (put_in > 0).select(not_known / (put_in + not_known), 0);
  estimate.square = (relative.square() * square).sum();
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const Rgb power = put_in.row(s).transpose();
    estimate.of_element.push_back((power > 0).select(of_element[at(e)] / power, 0).maxCoeff());
  }
  constexpr double much = 0.1;  // of the most that one does not know
  const double most = *std::max_element(estimate.of_element.begin(), estimate.of_element.end());
  for (int e = 0; e < mesh.count(); ++e) {
    if (estimate.of_element[at(e)] <= much * most)
      estimate.of_element[at(e)] = 0;
    else
      estimate.elements += graded * unsure[at(e)].parts;
  }
  return estimate;
}

std::vector<UnsureLoss> unsure_by_rays(const ReflectedSystem& system,
                                       const std::vector<double>& rays) {
  const auto& [mesh, light, exchange, systems] = system;
  constexpr double rule_of_three = 3;
  std::vector<double> cast(at(systems.count()), 0);
  std::vector<UnsureLoss> unsure;
  for (int e = 0; e < mesh.count(); ++e)
    cast[at(systems.of_element[at(e)])] +=
        rays[at(e)] *
        static_cast<double>(element_nodes_of(mesh.order[at(mesh.triangle[at(e)])]).places.size());
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    unsure.push_back({systems.closed[at(s)] ? 0 : rule_of_three / cast[at(s)], 0});
  }
  return unsure;
}

}  // namespace halfshade
