#include "solver/linear/radiosity.h"

#include "meshing/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

Exchange make_exchange(const Eigen::MatrixXd& mutual_areas, const Eigen::ArrayXd& area) {
  Exchange exchange;
  exchange.matrix = mutual_areas.sparseView();
  exchange.area = area;
  exchange.enclosures.of_element.assign(static_cast<std::size_t>(area.size()), 0);
  exchange.enclosures.closed = {
      ((mutual_areas.rowwise().sum().array() / area - 1).abs() < 1e-9).all()};
  exchange.enclosures.lit = {true};
  return exchange;
}

/// The six faces of the unit cube by the closed forms: 0.1998… to the opposite face, the rest
/// shared.
Exchange cube() {
  const double opposite = 0.199824895698, beside = (1 - opposite) / 4;
  Eigen::MatrixXd M = Eigen::MatrixXd::Constant(6, 6, beside);
  for (int i = 0; i < 6; ++i) {
    M(i, i) = 0;
    M(i, i ^ 1) = opposite;
  }
  return make_exchange(M, Eigen::ArrayXd::Ones(6));
}

/// Concentric spheres of radius 1 and 2, the inner one first.
Exchange spheres() {
  const double a = 4 * std::numbers::pi;
  Eigen::MatrixXd M(2, 2);
  M << 0, a, a, 3 * a;
  Eigen::ArrayXd area(2);
  area << a, 4 * a;
  return make_exchange(M, area);
}

ChannelArray grey(const Eigen::ArrayXd& values) { return values.replicate(1, 3); }

Solution solved(const Exchange& exchange, const ChannelArray& rho, const ChannelArray& exitance,
                RadiosityReport& report, RadiosityOptions options = {}) {
  return solve_radiosity(exchange, rho, exitance, {}, options, report);
}

TEST(Radiosity, ConcentricSpheres) {
  RadiosityReport report;
  const Solution s =
      solved(spheres(), grey(Eigen::Array2d(0.3, 0.6)), grey(Eigen::Array2d(1, 0)), report);
  EXPECT_NEAR(s.radiosity(0, 0), 1.0891089109, 1e-10);
  EXPECT_NEAR(s.radiosity(1, 0), 0.2970297030, 1e-10);
  EXPECT_EQ(report.channels, 1);
  EXPECT_EQ(report.unknowns, 2);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(s.radiosity(1, 2), s.radiosity(1, 0));
}

TEST(Radiosity, WhiteFurnaceForAnyReflectances) {
  ChannelArray rho(6, 3);
  rho << 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 0.999, 0.5, 0, 1, 0.9999, 0.3;
  RadiosityReport report;
  const Solution s = solved(cube(), rho, 1 - rho, report, {.tolerance = 1e-13});
  EXPECT_LE((s.radiosity - 1).abs().maxCoeff(), 1e-10);
  EXPECT_LE((s.irradiance - 1).abs().maxCoeff(), 1e-10);
  EXPECT_EQ(report.channels, 3);
  EXPECT_EQ(report.unknowns, 6);
  for (const ChannelReport& channel : report.channel) {
    EXPECT_LE(channel.balance, 1e-9);
    EXPECT_LE(channel.residual, 1e-12);
  }
}

TEST(Radiosity, BouncesSumTheGeometricSeries) {
  const double rho = 0.7, E = 2;
  for (const int n : {0, 1, 2, 10}) {
    RadiosityReport report;
    const Solution s = solved(cube(), grey(Eigen::ArrayXd::Constant(6, rho)),
                              grey(Eigen::ArrayXd::Constant(6, E)), report, {.bounces = n});
    EXPECT_NEAR(s.radiosity(3, 1), E * (1 - std::pow(rho, n + 1)) / (1 - rho), 1e-12) << n;
    EXPECT_NEAR(s.direct_irradiance(3, 1), E, 1e-12);
  }
}

TEST(Radiosity, DirectIrradianceIsWhatEmittersSend) {
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(6);
  E[4] = 5;
  RadiosityReport report;
  const Solution s = solved(cube(), grey(Eigen::ArrayXd::Constant(6, 0.5)), grey(E), report);
  EXPECT_EQ(s.direct_irradiance(4, 0), 0);
  EXPECT_NEAR(s.direct_irradiance(5, 0), 5 * 0.199824895698, 1e-12);
  EXPECT_NEAR(s.direct_irradiance(0, 0), 5 * 0.200043776075, 1e-11);
  // Flux balance: the mean irradiance of a closed scene with one reflectance is Φ/(A(1 − ρ)).
  EXPECT_NEAR(s.irradiance.col(0).mean(), 5 / (6 * 0.5), 1e-10);
}

TEST(Radiosity, BlackSurfacesNeedNoSolution) {
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(6);
  E[0] = 3;
  RadiosityReport report;
  const Solution s = solved(cube(), grey(Eigen::ArrayXd::Zero(6)), grey(E), report);
  EXPECT_EQ(report.unknowns, 0);
  EXPECT_LE(report.channel[0].iterations, 1);
  EXPECT_TRUE((s.radiosity == grey(E)).all());
  EXPECT_NEAR(s.irradiance(1, 0), 3 * 0.199824895698, 1e-12);
}

TEST(Radiosity, LightThatLeavesThroughAnOpeningIsAccountedFor) {
  // The cube without its last face: what went there escapes.
  const Exchange closed = cube();
  const Exchange open =
      make_exchange(Eigen::MatrixXd(closed.matrix).topLeftCorner(5, 5), Eigen::ArrayXd::Ones(5));
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(5);
  E[4] = 1;
  RadiosityReport report;
  const Solution s = solved(open, grey(Eigen::ArrayXd::Constant(5, 0.8)), grey(E), report);
  EXPECT_LE(report.channel[0].balance, 1e-9);
  double escaped = 0.199824895698 * s.radiosity(4, 0);
  for (int i = 0; i < 4; ++i) escaped += 0.200043776075 * s.radiosity(i, 0);
  EXPECT_NEAR(report.channel[0].escaped_power, escaped, 1e-10);
}

TEST(Radiosity, AClosedPerfectMirrorWithALampIsRefused) {
  RadiosityReport report;
  const ChannelArray ones = grey(Eigen::ArrayXd::Ones(6));
  try {
    solved(cube(), ones, ones, report);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::invalid_input);
  }
  const Solution dark = solved(cube(), ones, 0 * ones, report);
  EXPECT_EQ(dark.radiosity.abs().maxCoeff(), 0);
  Eigen::ArrayXd one_absorbs = Eigen::ArrayXd::Ones(6);
  one_absorbs[2] = 0.5;
  const Solution lit = solved(cube(), grey(one_absorbs), ones, report);
  EXPECT_TRUE(report.converged);
  // Everything emitted ends in face 2: (1 − 0.5) H = 6.
  EXPECT_NEAR(lit.irradiance(2, 0), 12, 1e-8);
}

}  // namespace
}  // namespace halfshade
