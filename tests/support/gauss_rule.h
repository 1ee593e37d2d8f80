#pragma once

#include "meshing/core/error.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace halfshade::test {

/// A node in [0,1] and its weight; weights of a rule sum to 1.
struct LineNode {
  double x, weight;
};

inline constexpr int largest_gauss_rule = 16;

/// Roots of the Legendre polynomial of degree n by Newton's method.
inline std::vector<LineNode> make_gauss_rule(int n) {
  std::vector<LineNode> rule(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1;
    for (int step = 0; step < 8; ++step) {  // converges quadratically: 5 steps reach rounding error
      double previous = 1, value = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
      }
      slope = n * (previous - x * value) / (1 - x * x);
      x -= value / slope;
    }
    rule[static_cast<std::size_t>(n - 1 - i)] = {(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)};
  }
  return rule;
}

/// Gauss–Legendre rule with n nodes on [0,1], 1 ≤ n ≤ 16: exact for polynomials of degree 2n − 1.
/// Throws Error(contract) for other n.
inline std::span<const LineNode> gauss_rule(int n) {
  static const auto rules = [] {
    std::array<std::vector<LineNode>, largest_gauss_rule + 1> all;
    for (int k = 1; k <= largest_gauss_rule; ++k)
      all[static_cast<std::size_t>(k)] = make_gauss_rule(k);
    return all;
  }();
  if (n < 1 || n > largest_gauss_rule)
    throw Error(ErrorCode::contract, "gauss_rule",
                "there is no rule with " + std::to_string(n) + " nodes");
  return rules[static_cast<std::size_t>(n)];
}

}  // namespace halfshade::test
