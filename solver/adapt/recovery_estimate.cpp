#include "solver/adapt/recovery_estimate.h"

#include "solver/elements/vertex_values.h"

#include <cmath>

namespace halfshade {

Eigen::ArrayXd recovery_estimate(const ElementTable& elements, const ChannelArray& irradiance) {
  const ChannelArray at_points = values_at_points(elements, irradiance);
  Eigen::ArrayXd estimate(elements.count());
  for (int e = 0; e < elements.count(); ++e) {
    const auto& corner = elements.corners[static_cast<std::size_t>(e)];
    const Rgb a = (at_points.row(corner[0]) - irradiance.row(e)).transpose();
    const Rgb b = (at_points.row(corner[1]) - irradiance.row(e)).transpose();
    const Rgb c = (at_points.row(corner[2]) - irradiance.row(e)).transpose();
    // Mean over a triangle of the square of a linear function with the corner values a, b, c.
    estimate[e] = std::sqrt(((a * a + b * b + c * c + a * b + b * c + c * a) / 6).mean());
  }
  return estimate;
}

double relative_error(const ElementTable& elements, const ChannelArray& irradiance,
                      const Eigen::ArrayXd& estimate) {
  const Eigen::Map<const Eigen::ArrayXd> area(elements.area.data(), elements.count());
  const double norm = (area * irradiance.square().rowwise().mean()).sum();
  return norm > 0 ? std::sqrt((area * estimate.square()).sum() / norm) : 0;
}

}  // namespace halfshade
