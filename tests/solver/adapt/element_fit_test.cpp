#include "solver/adapt/element_fit.h"

#include "tests/support/random.h"
#include "tests/support/true_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace halfshade {
namespace {

/// Of a place in the standard triangle.
using InPlane = std::function<double(const TrianglePlace&)>;

constexpr double in_channel[3] = {1, 0.5, 2};

/// The function in all channels, in different sizes.
ElementFit fit(int order, const InPlane& f) {
  const TriangleRule& rule = sampling_rule(order);
  ChannelArray samples(rule.weights.size(), 3);
  for (std::size_t k = 0; k < rule.places.size(); ++k)
    for (int c = 0; c < 3; ++c)
      samples(static_cast<Eigen::Index>(k), c) = in_channel[c] * f(rule.places[k]);
  return fit_element(order, samples);
}

Rgb value(const ElementFit& fit, const TrianglePlace& place) {
  Eigen::VectorXd basis(basis_size(fit.order));
  basis_at(fit.order, place, basis);
  return fit.coefficients.matrix().transpose() * basis;
}

double true_error(const ElementFit& fit, const InPlane& f, int parts) {
  return std::sqrt(test::triangle_mean(parts, [&](const TrianglePlace& place) {
    const Rgb off = f(place) * Rgb(in_channel[0], in_channel[1], in_channel[2]) - value(fit, place);
    return off.matrix().squaredNorm();
  }));
}

double exponential(const TrianglePlace& p) { return std::exp(0.8 * p.x() - 0.5 * p.y()); }

/// Of a small light nearby.
double near_light(const TrianglePlace& p) {
  return 1 / ((p - TrianglePlace(0.7, 0.6)).squaredNorm() + 0.5);
}

TEST(ElementFit, PolynomialsUpToTheOrderAreExact) {
  test::Random random(1);
  for (int order = 0; order <= max_order; ++order) {
    const Eigen::MatrixX3d c = Eigen::MatrixX3d::NullaryExpr(
        basis_size(order), 3, [&](auto, auto) { return random(-1, 1); });
    const ElementFit fit =
        fit_element(order, (basis_at(order, sampling_rule(order).places) * c).array());
    EXPECT_EQ(fit.order, order);
    EXPECT_LT((fit.coefficients.matrix() - c).norm(), 1e-12) << order;
    EXPECT_LT(fit.error, 1e-12) << order;
    EXPECT_LT(fit.layer[at(order + 1)], 1e-12) << order;
    for (int degree = 0; degree <= order; ++degree)
      EXPECT_NEAR(fit.layer[at(degree)], c.middleRows(basis_size(degree - 1), degree + 1).norm(),
                  1e-12);
  }
}

TEST(ElementFit, OneDegreeMoreIsAllError) {
  test::Random random(2);
  for (int order = 0; order <= max_order; ++order) {
    Eigen::MatrixX3d c = Eigen::MatrixX3d::Zero(basis_size(order + 1), 3);
    for (double& entry : c.bottomRows(order + 2).reshaped()) entry = random(-1, 1);
    const ElementFit fit =
        fit_element(order, (basis_at(order + 1, sampling_rule(order).places) * c).array());
    EXPECT_LT(fit.coefficients.matrix().norm(), 1e-12) << order;
    EXPECT_NEAR(fit.layer[at(order + 1)], c.norm(), 1e-12) << order;
    EXPECT_GE(fit.error, 0.999 * c.norm()) << order;
    EXPECT_LE(fit.error, 3.4 * c.norm()) << order;
  }
}

TEST(ElementFit, TheErrorOfSmoothFunctionsIsClose) {
  for (const InPlane& f : {InPlane(exponential), InPlane(near_light)})
    for (int order = 0; order <= max_order; ++order) {
      const ElementFit of = fit(order, f);
      const double ratio = of.error / true_error(of, f, 2);
      EXPECT_GE(ratio, 0.9) << order;
      EXPECT_LE(ratio, 2) << order;
    }
}

/// Over many places of a break, and its directions: a single one may hide between the samples. What
/// matters is the sum over elements.
double error_ratio_of_breaks(int order, int parts, const std::function<double(double)>& f) {
  test::Random random(7);
  double estimated = 0, actual = 0;
  for (int i = 0; i < 40; ++i) {
    const double angle = random(0, 6.28), offset = random(-0.25, 0.25);
    const InPlane broken = [&](const TrianglePlace& p) {
      return f(std::cos(angle) * (p.x() - 1. / 3) + std::sin(angle) * (p.y() - 1. / 3) - offset);
    };
    const ElementFit of = fit(order, broken);
    estimated += of.error * of.error;
    actual += std::pow(true_error(of, broken, parts), 2);
  }
  return std::sqrt(estimated / actual);
}

TEST(ElementFit, TheErrorOfKinksIsClose) {
  for (int order = 0; order <= max_order; ++order) {
    const double ratio = error_ratio_of_breaks(order, 4, [](double d) { return std::abs(d); });
    EXPECT_GE(ratio, 0.8) << order;
    EXPECT_LE(ratio, 2) << order;
  }
}

TEST(ElementFit, TheErrorOfJumpsIsClose) {
  for (int order = 0; order <= max_order; ++order) {
    const double ratio = error_ratio_of_breaks(order, 8, [](double d) { return d > 0 ? 1 : 0; });
    EXPECT_GE(ratio, 0.8) << order;
    EXPECT_LE(ratio, 1.6) << order;
  }
}

TEST(ElementFit, SmoothFunctionsDecayAndBrokenOnesDoNot) {
  for (int order = 1; order <= max_order; ++order)
    EXPECT_LT(decay(fit(order, exponential)), 0.2) << order;
  for (int order = 2; order <= max_order; ++order)
    for (const double c : {0.26, 0.37, 0.48}) {
      const double of_jump =
          decay(fit(order, [c](const TrianglePlace& p) { return p.x() > c ? 1. : 0.; }));
      EXPECT_GT(of_jump, 0.5) << order << ", " << c;
      EXPECT_LE(of_jump, 1) << order << ", " << c;
    }
  EXPECT_EQ(decay(fit(0, exponential)), 1) << "nothing to tell it from";
  EXPECT_EQ(decay(fit(2, [](const TrianglePlace&) { return 0.; })), 0);
}

TEST(ElementFit, APartHasThePolynomialOfTheWhole) {
  test::Random random(3);
  for (int order = 0; order <= max_order; ++order) {
    const ElementFit whole = fit(order, near_light);
    const std::array<TrianglePlace, 3> corners = {TrianglePlace(0.5, 0.5), TrianglePlace(0, 0.5),
                                                  TrianglePlace(0.5, 0)};
    const ElementFit part = restrict_fit(whole, corners);
    EXPECT_EQ(part.order, order);
    EXPECT_EQ(part.error, whole.error);
    for (int i = 0; i < 20; ++i) {
      const double t = random(0, 1);
      const TrianglePlace place(random(0, 1 - t), t);
      const TrianglePlace in_whole = corners[0] + place.x() * (corners[1] - corners[0]) +
                                     place.y() * (corners[2] - corners[0]);
      EXPECT_LT((value(part, place) - value(whole, in_whole)).abs().maxCoeff(), 1e-11) << order;
    }
  }
}

TEST(ElementFit, DroppingADegreeCostsItsLayer) {
  for (const InPlane& f : {InPlane(exponential), InPlane(near_light)}) {
    ElementFit of = fit(max_order, f);
    while (of.order > 0) {
      const ElementFit before = of;
      lower_order(of);
      ASSERT_EQ(of.order, before.order - 1);
      ASSERT_EQ(of.coefficients.rows(), basis_size(of.order));
      EXPECT_TRUE((of.coefficients == before.coefficients.topRows(of.coefficients.rows())).all());
      EXPECT_NEAR(of.error, std::hypot(before.error, before.layer[at(before.order)]),
                  1e-15 * of.error);
      // What was fitted better is known better.
      EXPECT_NEAR(of.error / true_error(of, f, 2), 1, 0.1) << of.order;
    }
  }
}

}  // namespace
}  // namespace halfshade
