#include "solver/linear/two_levels.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

constexpr double opposite = 0.199824895698, beside = (1 - opposite) / 4;

/// The faces of the unit cube, closed forms.
Exchange cube_faces() {
  Eigen::MatrixXd M = Eigen::MatrixXd::Constant(6, 6, beside);
  for (int i = 0; i < 6; ++i) {
    M(i, i) = 0;
    M(i, i ^ 1) = opposite;
  }
  Exchange exchange;
  exchange.matrix = M.sparseView();
  exchange.area = Eigen::ArrayXd::Ones(6);
  exchange.lost = Eigen::ArrayXd::Zero(6);
  exchange.enclosures = {std::vector<int>(6, 0), {true}, {true}};
  return exchange;
}

ChannelArray column(std::initializer_list<double> values) {
  ChannelArray all(static_cast<Eigen::Index>(values.size()), 3);
  Eigen::Index row = 0;
  for (const double value : values) all.row(row++) << value, 2 * value / 3, value / 5;
  return all;
}

TEST(TwoLevels, AreTheMatrixWherePatchesAreTheElements) {
  const Exchange exchange = cube_faces();
  const std::vector<double> area(6, 1);
  const std::vector<int> itself = {0, 1, 2, 3, 4, 5};
  const PatchFactors factors = exchange.matrix;
  const ChannelArray rho = column({.9, .2, .5, .95, .1, 0}), light = column({0, 1, 0, 0, 2, 0});
  for (const int bounces : {-1, 0, 1, 5}) {
    RadiosityOptions options;
    options.tolerance = 1e-13;
    options.bounces = bounces;
    RadiosityReport report, other;
    const Solution right = solve_radiosity(exchange, rho, light, {}, options, other);
    const Solution found =
        solve_two_levels({area, itself, factors}, rho, light, {}, options, report);
    EXPECT_TRUE(found.irradiance.isApprox(right.irradiance, 1e-11)) << bounces;
    EXPECT_TRUE(found.radiosity.isApprox(right.radiosity, 1e-11)) << bounces;
    EXPECT_TRUE(found.direct_irradiance.isApprox(right.direct_irradiance, 1e-12));
    EXPECT_TRUE(report.converged);
  }
}

TEST(TwoLevels, APatchSendsTheMeanOfItsElements) {
  // Two patches that see each other alone, the second in two elements of areas 1 and 3 that see
  // .2 and .6 of the first: ½ in the mean.
  const std::vector<double> area = {2, 1, 3};
  const std::vector<int> patch_of = {0, 1, 1};
  PatchFactors factors(3, 2);
  factors.insert(0, 1) = 1;
  factors.insert(1, 0) = 0.2;
  factors.insert(2, 0) = 0.6;
  const ChannelArray rho = ChannelArray::Constant(3, 3, 0.5);
  ChannelArray light = ChannelArray::Zero(3, 3);
  light.row(0) = 1;
  RadiosityReport report;
  const Solution s = solve_two_levels({area, patch_of, factors}, rho, light, {}, {}, report);
  // R1 = ½ R2, R2 = ½ ½ (1 + R1): R2 = 2/7, R1 = 1/7.
  EXPECT_NEAR(s.irradiance(0, 0), 2. / 7, 1e-12);
  EXPECT_NEAR(s.irradiance(1, 1), 0.2 * 8 / 7, 1e-12);
  EXPECT_NEAR(s.irradiance(2, 2), 0.6 * 8 / 7, 1e-12);
  EXPECT_NEAR(s.direct_irradiance(2, 0), 0.6, 1e-15);
}

}  // namespace
}  // namespace halfshade
