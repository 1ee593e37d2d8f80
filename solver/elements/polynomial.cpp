#include "solver/elements/polynomial.h"

#include "meshing/core/error.h"
#include "solver/elements/quadrature.h"

#include <fmt/format.h>

#include <cmath>

namespace halfshade {
namespace {

constexpr int highest_basis = max_order + 2;
constexpr int most_polynomials = basis_size(highest_basis);

void check_order(int order, int highest, const char* caller) {
  if (order < 0 || order > highest)
    throw Error(ErrorCode::contract, caller,
                fmt::format("order {} is not between 0 and {}", order, highest));
}

/// A value and its derivatives with respect to x and y.
struct Jet {
  double value, dx, dy;

  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.dx * b.value + a.value * b.dx, a.dy * b.value + a.value * b.dy};
  }
  friend Jet operator*(double a, const Jet& b) { return {a * b.value, a * b.dx, a * b.dy}; }
  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.dx + b.dx, a.dy + b.dy};
  }
};

constexpr Jet constant(double value) { return {value, 0, 0}; }

template <class Number>
Number of(double value);
template <>
double of<double>(double value) {
  return value;
}
template <>
Jet of<Jet>(double value) {
  return constant(value);
}

/// Of the polynomial that has degree i along a b and i + j in all.
constexpr int index_of(int i, int j) { return basis_size(i + j - 1) + j; }

/// All polynomials at x, y ∈ [−1, 1], x + y ≤ 0, before they are normalised.
template <class Number>
void recur(int order, const Number& x, const Number& y, std::array<Number, most_polynomials>& phi) {
  const Number along = of<Number>(0.5) + x + 0.5 * y;
  const Number across = of<Number>(0.5) + -0.5 * y, across_2 = across * across;
  const auto entry = [&](int i, int j) -> Number& { return phi[at(index_of(i, j))]; };
  entry(0, 0) = of<Number>(1);
  for (int i = 0; i < order; ++i) {
    entry(i + 1, 0) = ((2. * i + 1) / (i + 1)) * (along * entry(i, 0));
    if (i > 0)
      entry(i + 1, 0) =
          entry(i + 1, 0) + (-static_cast<double>(i) / (i + 1)) * (across_2 * entry(i - 1, 0));
  }
  for (int i = 0; i < order; ++i) {
    entry(i, 1) = entry(i, 0) * (of<Number>(i + 0.5) + (i + 1.5) * y);
    const double alpha = 2. * i + 1;  // of the Jacobi polynomials in y
    for (int j = 1; i + j < order; ++j) {
      const double sum = 2 * j + alpha;
      const double a = (sum + 1) * (sum + 2) / (2 * (j + 1) * (j + alpha + 1));
      const double b = alpha * alpha * (sum + 1) / (2 * (j + 1) * (j + alpha + 1) * sum);
      const double c = (j + alpha) * j * (sum + 2) / ((j + 1) * (j + alpha + 1) * sum);
      entry(i, j + 1) = (of<Number>(b) + a * y) * entry(i, j) + -c * entry(i, j - 1);
    }
  }
}

template <class Use>
void for_each_polynomial(int order, const Use& use) {
  for (int degree = 0; degree <= order; ++degree)
    for (int j = 0; j <= degree; ++j)
      use(index_of(degree - j, j), std::sqrt((2. * (degree - j) + 1) * (degree + 1)));
}

/// VTK's order of a triangle's nodes; `add` gets the barycentric coordinates times the order.
void add_nodes(int order, int inset, std::vector<std::array<int, 3>>& nodes) {
  const int length = order - 3 * inset;
  const int near = inset, far = inset + length;
  if (length < 0) return;
  if (length == 0) {
    nodes.push_back({near, near, near});
    return;
  }
  nodes.insert(nodes.end(), {{far, near, near}, {near, far, near}, {near, near, far}});
  for (int k = 1; k < length; ++k) nodes.push_back({far - k, near + k, near});
  for (int k = 1; k < length; ++k) nodes.push_back({near, far - k, near + k});
  for (int k = 1; k < length; ++k) nodes.push_back({near + k, near, far - k});
  add_nodes(order, inset + 1, nodes);
}

struct NodeBases {
  std::array<Eigen::MatrixXd, max_order + 1> of_order;

  NodeBases() {
    for (int order = 0; order <= max_order; ++order)
      of_order[at(order)] = basis_at(order, element_nodes(order));
  }
};

}  // namespace

void basis_at(int order, const TrianglePlace& place, Eigen::Ref<Eigen::VectorXd> values) {
  check_order(order, highest_basis, "basis_at");
  std::array<double, most_polynomials> phi;
  recur<double>(order, 2 * place.x() - 1, 2 * place.y() - 1, phi);
  for_each_polynomial(order, [&](int k, double norm) { values[k] = norm * phi[at(k)]; });
}

Eigen::MatrixXd basis_at(int order, std::span<const TrianglePlace> places) {
  check_order(order, highest_basis, "basis_at");
  Eigen::MatrixXd values(places.size(), basis_size(order));
  Eigen::VectorXd row(basis_size(order));
  for (std::size_t i = 0; i < places.size(); ++i) {
    basis_at(order, places[i], row);
    values.row(static_cast<Eigen::Index>(i)) = row;
  }
  return values;
}

BasisDerivatives basis_derivatives_at(int order, std::span<const TrianglePlace> places) {
  check_order(order, highest_basis, "basis_derivatives_at");
  const auto rows = static_cast<Eigen::Index>(places.size());
  BasisDerivatives result{Eigen::MatrixXd(rows, basis_size(order)),
                          Eigen::MatrixXd(rows, basis_size(order))};
  std::array<Jet, most_polynomials> phi;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const TrianglePlace& place = places[static_cast<std::size_t>(i)];
    // x and y run twice as fast as s and t.
    recur<Jet>(order, {2 * place.x() - 1, 2, 0}, {2 * place.y() - 1, 0, 2}, phi);
    for_each_polynomial(order, [&](int k, double norm) {
      result.s(i, k) = norm * phi[at(k)].dx;
      result.t(i, k) = norm * phi[at(k)].dy;
    });
  }
  return result;
}

std::vector<TrianglePlace> element_nodes(int order) {
  check_order(order, max_order, "element_nodes");
  if (order == 0) return {TrianglePlace(1. / 3, 1. / 3)};
  std::vector<std::array<int, 3>> nodes;
  add_nodes(order, 0, nodes);
  std::vector<TrianglePlace> places;
  for (const auto& node : nodes) places.emplace_back(TrianglePlace(node[1], node[2]) / order);
  return places;
}

const Eigen::MatrixXd& element_node_basis(int order) {
  static const NodeBases bases;
  check_order(order, max_order, "element_node_basis");
  return bases.of_order[at(order)];
}

Eigen::MatrixXd restriction(int order, const std::array<TrianglePlace, 3>& corners) {
  const TriangleRule& rule = gauss_rule(2 * order);
  std::vector<TrianglePlace> in_whole;
  for (const TrianglePlace& place : rule.places)
    in_whole.push_back(corners[0] + place.x() * (corners[1] - corners[0]) +
                       place.y() * (corners[2] - corners[0]));
  return basis_at(order, rule.places).transpose() * rule.weights.asDiagonal() *
         basis_at(order, in_whole);
}

}  // namespace halfshade
