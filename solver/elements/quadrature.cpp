#include "solver/elements/quadrature.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

constexpr int largest_gauss_rule = 16;

/// Roots of the Legendre polynomial of degree n by Newton's method.
std::vector<LineNode> make_gauss_rule(int n) {
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

/// The three, or six, nodes that symmetry makes of one.
void add_orbit(std::vector<TriangleNode>& rule, double u, double v, double weight) {
  const std::array<double, 3> b = {u, v, 1 - u - v};
  for (std::size_t k = 0; k < 3; ++k) rule.push_back({b[k], b[(k + 1) % 3], weight});
  if (u != v)
    for (std::size_t k = 0; k < 3; ++k) rule.push_back({b[(k + 1) % 3], b[k], weight});
}

struct TriangleRules {
  std::array<std::vector<TriangleNode>, 4> rules;

  TriangleRules() {
    rules[0].push_back({1. / 3, 1. / 3, 1});
    add_orbit(rules[1], 1. / 6, 1. / 6, 1. / 3);
    add_orbit(rules[2], 0.445948490915965, 0.445948490915965, 0.223381589678011);
    add_orbit(rules[2], 0.091576213509771, 0.091576213509771, 0.109951743655322);
    add_orbit(rules[3], 0.249286745170910, 0.249286745170910, 0.116786275726379);
    add_orbit(rules[3], 0.063089014491502, 0.063089014491502, 0.050844906370207);
    add_orbit(rules[3], 0.310352451033784, 0.053145049844817, 0.082851075618374);
  }
};

}  // namespace

std::span<const LineNode> gauss_rule(int n) {
  static const auto rules = [] {
    std::array<std::vector<LineNode>, largest_gauss_rule + 1> all;
    for (int k = 1; k <= largest_gauss_rule; ++k)
      all[static_cast<std::size_t>(k)] = make_gauss_rule(k);
    return all;
  }();
  if (n < 1 || n > largest_gauss_rule)
    throw Error(ErrorCode::contract, "gauss_rule",
                fmt::format("there is no rule with {} nodes", n));
  return rules[static_cast<std::size_t>(n)];
}

std::span<const TriangleNode> triangle_rule(int degree) {
  static const TriangleRules all;
  if (degree <= 1) return all.rules[0];
  if (degree <= 2) return all.rules[1];
  if (degree <= 4) return all.rules[2];
  if (degree <= 6) return all.rules[3];
  throw Error(ErrorCode::contract, "triangle_rule",
              fmt::format("there is no rule of degree {}", degree));
}

}  // namespace halfshade
