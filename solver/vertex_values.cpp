#include "solver/vertex_values.h"

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
  return values.colwise() / weight;
}

}  // namespace halfshade
