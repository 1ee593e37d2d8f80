#include "solver/elements/straight_error.h"

#include "solver/elements/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// With n pieces along each edge, n⁴ times the mean square is a polynomial in 1/n² of this degree
/// less one: a sum over the pieces of a polynomial of where they are and of their size, which is as
/// it was if n is replaced by −n, for upright and turned pieces change places.
constexpr int few = max_order - 1;

/// The form that takes coefficients to the mean square where edges are cut into n pieces.
Eigen::MatrixXd mean_square_form(int n) {
  const TriangleRule& rule = gauss_rule(2 * max_order);
  const auto nodes = static_cast<Eigen::Index>(rule.places.size());
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(basis_size(max_order), basis_size(max_order));
  const auto add = [&](const std::array<TrianglePlace, 3>& corners) {
    std::vector<TrianglePlace> places;
    Eigen::MatrixXd straight(nodes, 3);
    for (Eigen::Index k = 0; k < nodes; ++k) {
      const TrianglePlace& p = rule.places[static_cast<std::size_t>(k)];
      straight.row(k) << 1 - p.x() - p.y(), p.x(), p.y();
      places.emplace_back(straight(k, 0) * corners[0] + p.x() * corners[1] + p.y() * corners[2]);
    }
    const Eigen::MatrixXd off =
        basis_at(max_order, places) - straight * basis_at(max_order, corners);
    form += off.transpose() * (rule.weights / (n * n)).asDiagonal() * off;
  };
  const auto place = [n](int i, int j) -> TrianglePlace { return TrianglePlace(i, j) / n; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i) {
      add({place(i, j), place(i + 1, j), place(i, j + 1)});
      if (i + j + 1 < n) add({place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)});
    }
  return form;
}

const std::array<Eigen::MatrixXd, few>& forms() {
  static const std::array<Eigen::MatrixXd, few> made = [] {
    std::array<Eigen::MatrixXd, few> all;
    for (int n = 1; n <= few; ++n) all[at(n - 1)] = mean_square_form(n);
    return all;
  }();
  return made;
}

}  // namespace

StraightError::StraightError(const ElementField& field, double scale)
    : of_few_(Eigen::MatrixXd::Zero(few, field.count())) {
  for (int e = 0; e < field.count(); ++e) {
    if (field.order[at(e)] <= 1) continue;
    const Eigen::MatrixXd coefficients = scale * field.of(e).matrix();
    const Eigen::Index size = coefficients.rows();
    for (int k = 0; k < few; ++k)
      of_few_(k, e) = std::max(
          0.,
          coefficients.cwiseProduct(forms()[at(k)].topLeftCorner(size, size) * coefficients).sum());
  }
}

double StraightError::mean_square(int element, int along_edge) {
  if (along_edge <= few) return of_few_(along_edge - 1, element);
  return std::max(0., weights(along_edge).dot(of_few_.col(element)));
}

/// Lagrange's, towards smaller pieces, where they are small themselves (as in Romberg's rule).
const Eigen::VectorXd& StraightError::weights(int along_edge) {
  if (at(along_edge) >= weights_.size()) weights_.resize(at(along_edge) + 1);
  Eigen::VectorXd& found = weights_[at(along_edge)];
  if (found.size() > 0) return found;
  const auto size = [](int n) { return 1. / n / n; };
  found.resize(few);
  for (int k = 1; k <= few; ++k) {
    double weight = std::pow(static_cast<double>(k) / along_edge, 4);
    for (int j = 1; j <= few; ++j)
      if (j != k) weight *= (size(along_edge) - size(j)) / (size(k) - size(j));
    found[k - 1] = weight;
  }
  return found;
}

}  // namespace halfshade
