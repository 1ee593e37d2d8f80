#include "solver/elements/quadrature.h"

#include "meshing/core/error.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <array>
#include <cmath>
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

/// Places in [−1, 1] and weights that sum to 1.
struct LineRule {
  Eigen::VectorXd places, weights;
};

/// Gauss's rule with `count` places for the weight (1 − x)^alpha, alpha 0 or 1.
LineRule line_rule(int count, int alpha) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(count, count);
  for (int k = 0; k < count; ++k) {
    const double sum = 2. * k + alpha;
    jacobi(k, k) = alpha == 0 ? 0 : -1 / (sum * (sum + 2));
    if (k == 0) continue;
    const double square =
        4. * k * (k + alpha) * k * (k + alpha) / (sum * sum * (sum + 1) * (sum - 1));
    jacobi(k, k - 1) = jacobi(k - 1, k) = std::sqrt(square);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(jacobi);
  return {solver.eigenvalues(), solver.eigenvectors().row(0).cwiseAbs2()};
}

TriangleRule product_rule(int count) {
  const LineRule along = line_rule(count, 0), across = line_rule(count, 1);
  TriangleRule rule;
  rule.weights.resize(count * count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const double t = (1 + across.places[j]) / 2, s = (1 - t) * (1 + along.places[i]) / 2;
      rule.places.emplace_back(s, t);
      rule.weights[i * count + j] = along.weights[i] * across.weights[j];
    }
  return rule;
}

struct GaussRules {
  std::array<TriangleRule, highest_gauss_degree / 2 + 1> rules;

  GaussRules() {
    for (std::size_t k = 0; k < rules.size(); ++k) rules[k] = product_rule(static_cast<int>(k) + 1);
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

const TriangleRule& gauss_rule(int degree) {
  static const GaussRules all;
  if (degree < 0 || degree > highest_gauss_degree)
    throw Error(ErrorCode::contract, "gauss_rule",
                fmt::format("there is no rule of degree {}", degree));
  return all.rules[static_cast<std::size_t>(degree) / 2];
}

}  // namespace halfshade
