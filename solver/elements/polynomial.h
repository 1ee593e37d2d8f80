#pragma once

#include "meshing/core/types.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// The highest order of an element.
inline constexpr int max_order = 8;

/// How many polynomials in two variables of degree ≤ order are independent.
constexpr int basis_size(int order) { return (order + 1) * (order + 2) / 2; }

/// Place in a triangle a, b, c: a + s (b − a) + t (c − a).
using TrianglePlace = Eigen::Vector2d;

/// Values of the orthonormal polynomials of a triangle (Dubiner 1991), by recurrences without a
/// division (Kirby 2010): one row a place, one column a polynomial. Degrees rise: the first
/// basis_size(k) span all polynomials of degree ≤ k. Orthonormal in the mean over the triangle, so
/// that the first is 1, the coefficient of it is the mean, and the sum of squared coefficients is
/// the mean square. Defined outside the triangle, too. Throws Error(contract) for an order outside
/// [0, max_order + 2]: estimates look a little further than elements go.
Eigen::MatrixXd basis_at(int order, std::span<const TrianglePlace> places);

/// Derivatives of the same with respect to s and t.
struct BasisDerivatives {
  Eigen::MatrixXd s, t;
};
BasisDerivatives basis_derivatives_at(int order, std::span<const TrianglePlace> places);

/// The same for a single place, without memory of its own; `values` has basis_size(order) entries.
void basis_at(int order, const TrianglePlace& place, Eigen::Ref<Eigen::VectorXd> values);

/// Where a polynomial of that order is told by its values, evenly spaced, in VTK's order: corners,
/// then inner nodes of the edges a b, b c, c a, then the inside, likewise, from outside in. The
/// centroid for order 0.
std::vector<TrianglePlace> element_nodes(int order);

/// basis_at(order, element_nodes(order)), made once. `values = element_node_basis(p) *
/// coefficients`.
const Eigen::MatrixXd& element_node_basis(int order);

/// Takes the coefficients on a triangle to those on a part of it: `corners` are the part's, as
/// places in the whole. Exact for polynomials of the order.
Eigen::MatrixXd restriction(int order, const std::array<TrianglePlace, 3>& corners);

}  // namespace halfshade
