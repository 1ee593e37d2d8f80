#pragma once

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

}  // namespace halfshade
