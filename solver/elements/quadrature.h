#pragma once

#include <span>

namespace halfshade {

/// A node in [0,1] and its weight; weights of a rule sum to 1.
struct LineNode {
  double x, weight;
};

/// Gauss–Legendre rule with n nodes on [0,1], 1 ≤ n ≤ 16: exact for polynomials of degree 2n − 1.
/// Throws Error(contract) for other n.
std::span<const LineNode> gauss_rule(int n);

/// Barycentric coordinates u, v (and 1 − u − v) of a node and its weight; weights sum to 1.
struct TriangleNode {
  double u, v, weight;
};

/// The smallest of the symmetric rules with 1, 3, 6 and 12 nodes that is exact for polynomials of
/// `degree` ≤ 1, 2, 4 and 6 (Dunavant 1985). All nodes lie inside the triangle. Throws
/// Error(contract) for a higher degree.
std::span<const TriangleNode> triangle_rule(int degree);

}  // namespace halfshade
