#include "solver/elements/polynomial.h"

#include "solver/elements/element_field.h"
#include "solver/elements/quadrature.h"
#include "tests/support/expect_error.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

std::vector<TrianglePlace> some_places(int count) {
  test::Random random(7);
  std::vector<TrianglePlace> places;
  while (static_cast<int>(places.size()) < count) {
    const TrianglePlace place(random(0, 1), random(0, 1));
    if (place.sum() <= 1) places.push_back(place);
  }
  return places;
}

TEST(Polynomial, BasisIsOrthonormalInTheMean) {
  const TriangleRule& rule = gauss_rule(2 * max_order + 4);
  const Eigen::MatrixXd values = basis_at(max_order + 2, rule.places);
  const Eigen::MatrixXd products = values.transpose() * rule.weights.asDiagonal() * values;
  EXPECT_LT((products - Eigen::MatrixXd::Identity(products.rows(), products.cols()))
                .cwiseAbs()
                .maxCoeff(),
            1e-13);
}

TEST(Polynomial, DegreesRise) {
  // A monomial of degree k needs none of the polynomials above it.
  const TriangleRule& rule = gauss_rule(2 * max_order);
  const Eigen::MatrixXd values = basis_at(max_order, rule.places);
  for (int k = 0; k <= max_order; ++k) {
    Eigen::VectorXd monomial(rule.weights.size());
    for (Eigen::Index i = 0; i < monomial.size(); ++i) {
      const TrianglePlace& place = rule.places[static_cast<std::size_t>(i)];
      monomial[i] = std::pow(place.x(), k / 2) * std::pow(place.y(), k - k / 2);
    }
    const Eigen::VectorXd coefficients = values.transpose() * rule.weights.cwiseProduct(monomial);
    const Eigen::Index above = coefficients.size() - basis_size(k);
    EXPECT_LT(coefficients.tail(above).cwiseAbs().sum(), 1e-12) << k;
    EXPECT_LT((values * coefficients - monomial).cwiseAbs().maxCoeff(), 1e-12) << k;
  }
}

TEST(Polynomial, DerivativesAreThoseOfTheValues) {
  constexpr double step = 1e-5;
  for (const TrianglePlace& place : some_places(20)) {
    const BasisDerivatives derivatives = basis_derivatives_at(max_order, {&place, 1});
    const auto difference = [&](const TrianglePlace& along) -> Eigen::RowVectorXd {
      const std::vector<TrianglePlace> ends = {place + step * along, place - step * along};
      const Eigen::MatrixXd values = basis_at(max_order, ends);
      return (values.row(0) - values.row(1)) / (2 * step);
    };
    EXPECT_LT((difference({1, 0}) - derivatives.s).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((difference({0, 1}) - derivatives.t).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(Polynomial, NodesTellThePolynomial) {
  for (int order = 0; order <= max_order; ++order) {
    const Eigen::MatrixXd& values = element_node_basis(order);
    ASSERT_EQ(values.rows(), basis_size(order));
    EXPECT_GT(values.jacobiSvd().singularValues().tail(1)[0], 1e-3) << order;
  }
}

TEST(Polynomial, ARestrictionIsTheSamePolynomial) {
  const std::array<TrianglePlace, 3> part = {TrianglePlace(0.5, 0), TrianglePlace(0.5, 0.5),
                                             TrianglePlace(0.1, 0.2)};
  for (int order = 0; order <= max_order; ++order) {
    const Eigen::VectorXd whole = Eigen::VectorXd::LinSpaced(basis_size(order), 1, 2);
    const Eigen::VectorXd restricted = restriction(order, part) * whole;
    const auto places = some_places(5);
    for (const TrianglePlace& place : places) {
      const TrianglePlace in_whole =
          part[0] + place.x() * (part[1] - part[0]) + place.y() * (part[2] - part[0]);
      EXPECT_NEAR(basis_at(order, {&place, 1}).row(0).dot(restricted),
                  basis_at(order, {&in_whole, 1}).row(0).dot(whole), 1e-11);
    }
  }
}

TEST(Polynomial, OrdersOutOfRangeAreRefused) {
  const TrianglePlace place(0.2, 0.3);
  for (const int order : {-1, max_order + 3})
    test::expect_error([&] { basis_at(order, {&place, 1}); }, ErrorCode::contract, {"order"});
  test::expect_error([] { element_nodes(max_order + 1); }, ErrorCode::contract, {"order 9"});
}

TEST(TriangleGaussRule, IsExactForItsDegree) {
  for (int degree = 0; degree <= highest_gauss_degree; ++degree) {
    const TriangleRule& rule = gauss_rule(degree);
    EXPECT_GT(rule.weights.minCoeff(), 0);
    for (int a = 0; a <= degree; ++a) {
      const int b = degree - a;
      double sum = 0;
      for (std::size_t i = 0; i < rule.places.size(); ++i) {
        const TrianglePlace& place = rule.places[i];
        EXPECT_GT(std::min({place.x(), place.y(), 1 - place.sum()}), 0);
        sum += rule.weights[static_cast<Eigen::Index>(i)] * std::pow(place.x(), a) *
               std::pow(place.y(), b);
      }
      const double exact =
          2 * std::exp(std::lgamma(a + 1) + std::lgamma(b + 1) - std::lgamma(degree + 3));
      EXPECT_NEAR(sum / exact, 1, 1e-12) << degree << " " << a;
    }
  }
}

TEST(ElementField, PlacesAndPositionsAgree) {
  const std::array<Vec3, 3> triangle = {Vec3(1, 2, 3), Vec3(2, 2, 4), Vec3(1, 3.5, 3)};
  for (const TrianglePlace& place : some_places(5))
    EXPECT_LT((place_of(triangle, position(triangle, place)) - place).norm(), 1e-14);
}

}  // namespace
}  // namespace halfshade
