#include "solver/elements/quadrature.h"

#include "meshing/core/error.h"
#include "tests/support/gauss_rule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

TEST(GaussRule, IsExactForItsDegreeAndNotBeyond) {
  for (int n = 1; n <= 16; ++n) {
    for (int degree = 0; degree <= 2 * n; ++degree) {
      double sum = 0;
      for (const test::LineNode& node : test::gauss_rule(n))
        sum += node.weight * std::pow(node.x, degree);
      const double error = std::abs(sum - 1. / (degree + 1));
      if (degree < 2 * n) {
        EXPECT_LE(error, 1e-15) << n << " nodes, degree " << degree;
      } else if (n <= 8) {
        EXPECT_GT(error, 1e-12) << n << " nodes, degree " << degree;
      }
    }
  }
  EXPECT_THROW(test::gauss_rule(0), Error);
  EXPECT_THROW(test::gauss_rule(17), Error);
}

TEST(TriangleRule, IntegratesMonomialsOfItsDegreeWithNodesInside) {
  for (const int degree : {1, 2, 4, 6}) {
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j) {
        double sum = 0;
        for (const TriangleNode& node : triangle_rule(degree)) {
          sum += node.weight * std::pow(node.u, i) * std::pow(node.v, j);
          EXPECT_GT(std::min({node.u, node.v, 1 - node.u - node.v}), 0);
        }
        // Mean of u^i v^j over the triangle: 2 i! j! / (i + j + 2)!
        const double mean = 2 * std::tgamma(i + 1) * std::tgamma(j + 1) / std::tgamma(i + j + 3);
        EXPECT_NEAR(sum, mean, 1e-14) << "degree " << degree << ", u^" << i << " v^" << j;
      }
  }
  EXPECT_THROW(triangle_rule(7), Error);
}

}  // namespace
}  // namespace halfshade
