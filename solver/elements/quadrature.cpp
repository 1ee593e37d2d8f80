#include "solver/elements/quadrature.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

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
