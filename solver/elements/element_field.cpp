#include "solver/elements/element_field.h"

#include <Eigen/Dense>

namespace halfshade {

ElementField zero_field(std::vector<int> order) {
  ElementField field;
  field.first = {0};
  for (const int p : order) field.first.push_back(field.first.back() + basis_size(p));
  field.order = std::move(order);
  field.coefficients = ChannelArray::Zero(field.first.back(), 3);
  return field;
}

Rgb value_at(const ElementField& field, int element, const TrianglePlace& place) {
  const int order = field.order[at(element)];
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, basis_size(max_order), 1> values(basis_size(order));
  basis_at(order, place, values);
  return field.of(element).matrix().transpose() * values;
}

Eigen::Matrix3d gradient_at(const ElementField& field, const ElementTable& elements, int element,
                            const TrianglePlace& place) {
  const BasisDerivatives basis = basis_derivatives_at(field.order[at(element)], {&place, 1});
  const auto triangle = elements.triangle(element);
  Eigen::Matrix<double, 3, 2> edges;
  edges << triangle[1] - triangle[0], triangle[2] - triangle[0];
  Eigen::Matrix<double, 3, 2> slopes;  // one row a channel
  slopes << (basis.s * field.of(element).matrix()).transpose(),
      (basis.t * field.of(element).matrix()).transpose();
  return slopes * (edges.transpose() * edges).inverse() * edges.transpose();
}

ChannelArray means(const ElementField& field) {
  ChannelArray result(field.count(), 3);
  for (int e = 0; e < field.count(); ++e) result.row(e) = field.of(e).row(0);
  return result;
}

double square_integral(const ElementField& field, const ElementTable& elements) {
  double sum = 0;
  for (int e = 0; e < field.count(); ++e)
    sum += elements.area[at(e)] * field.of(e).matrix().squaredNorm();
  return sum;
}

TrianglePlace place_of(const std::array<Vec3, 3>& triangle, const Vec3& point) {
  Eigen::Matrix<double, 3, 2> edges;
  edges << triangle[1] - triangle[0], triangle[2] - triangle[0];
  return edges.colPivHouseholderQr().solve(point - triangle[0]);
}

}  // namespace halfshade
