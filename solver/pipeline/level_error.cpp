#include "solver/pipeline/level_error.h"

#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// By how much the share that each element loses varies over it.
Eigen::ArrayXd variation_of_lost(const ElementTable& elements, const Exchange& exchange) {
  const Eigen::ArrayXd share = (exchange.lost / exchange.area).max(0).min(1);
  // No share varies by more than one that is 0 or 1 everywhere.
  return recovery_estimate(elements, share.replicate<1, 3>()).min((share * (1 - share)).sqrt());
}

}  // namespace

Eigen::ArrayXd level_error(const ElementTable& elements, const Exchange& exchange,
                           const MaterialArrays& materials, const ChannelArray& irradiance) {
  const Enclosures& enclosures = exchange.enclosures;
  // Squares of light of any size must not over- or underflow.
  const double scale = balancing_scale(irradiance.maxCoeff());
  const auto root_mean_square = [](const ChannelArray& light) {
    return Eigen::ArrayXd(light.square().rowwise().mean().sqrt());
  };
  const Eigen::ArrayXd of_lost = variation_of_lost(elements, exchange),
                       of_light = recovery_estimate(elements, scale * irradiance),
                       light = root_mean_square(scale * irradiance),
                       emitted = root_mean_square(scale * materials.exitance);
  std::vector<double> unknown(at(enclosures.count())), put_in(at(enclosures.count()));
  for (int e = 0; e < elements.count(); ++e) {
    const auto group = at(enclosures.of_element[at(e)]);
    unknown[group] += exchange.area[e] * materials.rho.row(e).maxCoeff() * of_light[e] * of_lost[e];
    put_in[group] += exchange.area[e] * emitted[e];
  }
  Eigen::ArrayXd error = Eigen::ArrayXd::Zero(elements.count());
  for (int e = 0; e < elements.count(); ++e) {
    const auto group = at(enclosures.of_element[at(e)]);
    if (!enclosures.is_closed(e) && put_in[group] > 0)
      error[e] = unknown[group] / put_in[group] * light[e] / scale;
  }
  return error;
}

}  // namespace halfshade
