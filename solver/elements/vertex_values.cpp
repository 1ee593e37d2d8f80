#include "solver/elements/vertex_values.h"

namespace halfshade {

ChannelArray values_at_points(const ElementTable& elements, const ChannelArray& element_values) {
  const auto count = static_cast<Eigen::Index>(elements.points.size());
  ChannelArray values = ChannelArray::Zero(count, 3);
  Eigen::ArrayXd weight = Eigen::ArrayXd::Zero(count);
  for (int e = 0; e < elements.count(); ++e)
    for (const int p : elements.corners[static_cast<std::size_t>(e)]) {
      const double area = elements.area[static_cast<std::size_t>(e)];
      values.row(p) += area * element_values.row(e);
      weight[p] += area;
    }
  // A point without elements keeps zero instead of 0/0.
  return values.colwise() / (weight > 0).select(weight, 1.0);
}

}  // namespace halfshade
