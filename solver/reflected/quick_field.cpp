#include "solver/reflected/quick_field.h"

#include <Eigen/Dense>

#include <array>
#include <utility>

namespace halfshade {
namespace {

Eigen::MatrixXd to_powers(int order) {
  const auto nodes = element_nodes(order);
  Eigen::MatrixXd powers(nodes.size(), basis_size(order));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double s = nodes[i].x(), t = nodes[i].y();
    const std::array<double, 10> row = {1,     s,         t,         s * s,     s * t,
                                        t * t, s * s * s, s * s * t, s * t * t, t * t * t};
    for (int k = 0; k < basis_size(order); ++k)
      powers(static_cast<Eigen::Index>(i), k) = row[at(k)];
  }
  return powers.fullPivLu().solve(element_node_basis(order));
}

}  // namespace

const Eigen::MatrixXd& change_to_powers(int order) {
  static const std::array<Eigen::MatrixXd, max_reflected_order + 1> change = {
      to_powers(0), to_powers(1), to_powers(2), to_powers(3)};
  return change[at(order)];
}

QuickField::QuickField(const ElementField& field) {
  powers_.reserve(at(field.first.back()));
  for (int e = 0; e < field.count(); ++e) {
    const int order = field.order[at(e)];
    parts_.push_back({static_cast<int>(powers_.size()), order});
    const Eigen::MatrixXd powers = change_to_powers(order) * field.of(e).matrix();
    for (Eigen::Index k = 0; k < powers.rows(); ++k)
      powers_.emplace_back(powers.row(k).transpose());
  }
}

QuickField::QuickField(const ReflectedMesh& mesh, const ElementField& field) : QuickField(field) {
  std::vector<Part> of_triangles;
  for (const int e : mesh.element) of_triangles.push_back(e < 0 ? Part{0, 0} : parts_[at(e)]);
  parts_ = std::move(of_triangles);
}

}  // namespace halfshade
