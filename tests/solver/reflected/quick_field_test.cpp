#include "solver/reflected/quick_field.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(QuickField, IsTheField) {
  test::Random random(9);
  ElementField field = zero_field({0, 1, 2, 3, 1});
  for (double& c : field.coefficients.reshaped()) c = random(-1, 1);
  const QuickField quick(field);
  for (int e = 0; e < field.count(); ++e)
    for (int i = 0; i < 20; ++i) {
      const TrianglePlace place(random(0, 1), random(0, 1));
      EXPECT_LT((quick.value(e, place) - value_at(field, e, place)).abs().maxCoeff(), 1e-12) << e;
    }
}

TEST(QuickField, NodesTakeAPolynomialToItself) {
  test::Random random(10);
  for (int p = 0; p <= max_reflected_order; ++p) {
    const ElementNodes& nodes = element_nodes_of(p);
    const Eigen::VectorXd c =
        Eigen::VectorXd::NullaryExpr(basis_size(p), [&] { return random(-1, 1); });
    EXPECT_LT((nodes.fit * (basis_at(p, nodes.places) * c) - c).norm(), 1e-12) << p;
  }
}

}  // namespace
}  // namespace halfshade
