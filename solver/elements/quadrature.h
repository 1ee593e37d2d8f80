#pragma once

#include "solver/elements/polynomial.h"

#include <span>

namespace halfshade {

/// Barycentric coordinates u, v (and 1 − u − v) of a node and its weight; weights sum to 1.
struct TriangleNode {
  double u, v, weight;
};

/// The smallest of the symmetric rules with 1, 3, 6 and 12 nodes that is exact for polynomials of
/// `degree` ≤ 1, 2, 4 and 6 (Dunavant 1985). All nodes lie inside the triangle. Throws
/// Error(contract) for a higher degree.
std::span<const TriangleNode> triangle_rule(int degree);

/// A rule of any degree: places inside the triangle, and weights > 0 that sum to 1.
struct TriangleRule {
  std::vector<TrianglePlace> places;
  Eigen::VectorXd weights;

  double count() const { return static_cast<double>(places.size()); }
};

inline constexpr int highest_gauss_degree = 2 * max_order + 6;

/// Exact for polynomials of `degree` ≤ highest_gauss_degree: products of Gauss's rules on an
/// edge and, with the weight of a triangle, across it (Stroud 1971), (degree / 2 + 1)² places.
/// Computed once, from the eigenvalues of Jacobi matrices (Golub and Welsch 1969).
const TriangleRule& gauss_rule(int degree);

}  // namespace halfshade
