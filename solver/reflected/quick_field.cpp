#include "solver/reflected/quick_field.h"

#include <Eigen/Dense>

#include <array>

namespace halfshade {
namespace {

/// Takes coefficients of the orthonormal polynomials to those of 1, s, t, s², st, t², s³, s²t, st²,
/// t³.
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

QuickField::QuickField(const ElementField& field) : order_(field.order), first_(field.first) {
  static const std::array<Eigen::MatrixXd, max_reflected_order + 1> change = {
      to_powers(0), to_powers(1), to_powers(2), to_powers(3)};
  powers_.resize(at(first_.back()));
  for (int e = 0; e < field.count(); ++e) {
    const Eigen::MatrixXd powers = change[at(order_[at(e)])] * field.of(e).matrix();
    for (Eigen::Index k = 0; k < powers.rows(); ++k)
      powers_[at(first_[at(e)]) + static_cast<std::size_t>(k)] = powers.row(k).transpose();
  }
}

}  // namespace halfshade
