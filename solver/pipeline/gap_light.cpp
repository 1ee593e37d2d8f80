#include "solver/pipeline/gap_light.h"

#include "solver/elements/balancing_scale.h"

#include <span>
#include <vector>

namespace halfshade {
namespace {

/// Elements that send more of their light than this to a single other one are near to it.
constexpr double near_share = 0.5;

std::vector<bool> near_others(const Exchange& exchange) {
  std::vector<bool> is_near(static_cast<std::size_t>(exchange.area.size()), false);
  for (Eigen::Index i = 0; i < exchange.matrix.outerSize(); ++i)
    for (ExchangeMatrix::InnerIterator entry(exchange.matrix, i); entry; ++entry)
      if (entry.value() > near_share * exchange.area[i])
        is_near[static_cast<std::size_t>(i)] = true;
  return is_near;
}

}  // namespace

double light_in_gaps(const Exchange& exchange, const MaterialArrays& materials,
                     const ChannelArray& irradiance) {
  if (exchange.matrix.nonZeros() == 0) return 0;
  const std::vector<bool> is_near = near_others(exchange);
  // Light of any size must not over- or underflow.
  const Rgb strongest = materials.exitance.colwise().maxCoeff();
  const Rgb scale = balancing_scale(std::span(&strongest, 1));
  Rgb reflected = Rgb::Zero(), emitted = Rgb::Zero();
  for (Eigen::Index e = 0; e < irradiance.rows(); ++e) {
    const double area = exchange.area[e];
    emitted += area * scale * materials.exitance.row(e).transpose();
    if (is_near[static_cast<std::size_t>(e)] && !exchange.enclosures.is_closed(static_cast<int>(e)))
      reflected += area * scale * (materials.rho.row(e) * irradiance.row(e)).transpose();
  }
  return (reflected / (emitted > 0).select(emitted, 1)).maxCoeff();
}

}  // namespace halfshade
