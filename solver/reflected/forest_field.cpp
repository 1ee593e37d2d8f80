#include "solver/reflected/forest_field.h"

namespace halfshade {

const Eigen::MatrixXd& restriction_to_half(int order, int cut, int half) {
  static const auto table = [] {
    std::array<std::array<std::array<Eigen::MatrixXd, 2>, 3>, max_reflected_order + 1> all;
    const std::array<TrianglePlace, 3> corner = {TrianglePlace(0, 0), {1, 0}, {0, 1}};
    for (int p = 0; p <= max_reflected_order; ++p)
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        const TrianglePlace middle = 0.5 * (corner[a] + corner[b]);
        all[at(p)][a][0] = restriction(p, {corner[a], middle, corner[c]});
        all[at(p)][a][1] = restriction(p, {middle, corner[b], corner[c]});
      }
    return all;
  }();
  return table[at(order)][at(cut)][at(half)];
}

namespace {

void restrict_to(const ReflectedMesh& fine, int triangle, int order,
                 const ChannelArray& coefficients, ElementField& result) {
  if (fine.forest.is_leaf(triangle)) {
    result.of(fine.element[at(triangle)]) = coefficients;
    return;
  }
  for (int half = 0; half < 2; ++half)
    restrict_to(
        fine, fine.forest.first_half(triangle) + half, order,
        (restriction_to_half(order, fine.forest.cut(triangle), half) * coefficients.matrix())
            .array(),
        result);
}

}  // namespace

int forest_order(const ReflectedMesh& mesh, int triangle) {
  return mesh.forest.is_leaf(triangle) ? mesh.order[at(triangle)] : mesh.highest_order;
}

ElementField forest_field(const ReflectedMesh& mesh, const ElementField& field) {
  std::vector<int> order;
  for (int t = 0; t < mesh.forest.count(); ++t) order.push_back(forest_order(mesh, t));
  return forest_field(mesh, field, std::move(order));
}

ElementField forest_field(const ReflectedMesh& mesh, const ElementField& field,
                          std::vector<int> order) {
  const TriangleForest& forest = mesh.forest;
  ElementField result = zero_field(std::move(order));
  // Halves come after their whole.
  for (int t = forest.count() - 1; t >= 0; --t) {
    if (forest.is_leaf(t)) {
      result.of(t) = field.of(mesh.element[at(t)]);
      continue;
    }
    for (int half = 0; half < 2; ++half) {
      const auto part = result.of(forest.first_half(t) + half);
      // Of orthonormal polynomials, the projection is the transpose.
      result.of(t) += (0.5 *
                       restriction_to_half(result.order[at(t)], forest.cut(t), half)
                           .topRows(part.rows())
                           .transpose() *
                       part.matrix())
                          .array();
    }
  }
  return result;
}

ElementField restricted(const ReflectedMesh& mesh, const ElementField& field,
                        const ReflectedMesh& fine) {
  ElementField result = zero_field(fine);
  for (int e = 0; e < mesh.count(); ++e)
    restrict_to(fine, mesh.triangle[at(e)], field.order[at(e)], field.of(e), result);
  return result;
}

}  // namespace halfshade
