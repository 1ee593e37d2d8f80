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
  exchange.lost = (area - mutual_areas.rowwise().sum().array()).max(0.);
  if ((exchange.lost < 1e-9 * area).all()) exchange.lost.setZero();
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
    EXPECT_NEAR(s.irradiance(3, 1), E * (1 - std::pow(rho, n + 1)) / (1 - rho), 1e-12) << n;
    EXPECT_NEAR(s.radiosity(3, 1), E * (1 - std::pow(rho, n + 2)) / (1 - rho), 1e-12) << n;
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

/// Exchanges that do not see each other, as one.
Exchange side_by_side(const Exchange& a, const Exchange& b) {
  const auto n = static_cast<Eigen::Index>(a.area.size()), m = b.area.size();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + m, n + m);
  M.topLeftCorner(n, n) = Eigen::MatrixXd(a.matrix);
  M.bottomRightCorner(m, m) = Eigen::MatrixXd(b.matrix);
  Eigen::ArrayXd area(n + m);
  area << a.area, b.area;
  Exchange both = make_exchange(M, area);
  for (Eigen::Index e = n; e < n + m; ++e)
    both.enclosures.of_element[static_cast<std::size_t>(e)] = 1;
  both.enclosures.closed = {true, true};
  both.enclosures.lit = {true, true};
  return both;
}

TEST(Radiosity, RoomsThatDoNotSeeEachOtherAreSolvedApart) {
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(12), rho(12);
  rho << 0.1, 0.9, 0.5, 0.3, 0.7, 0.2, 0.1, 0.9, 0.5, 0.3, 0.7, 0.2;
  E[0] = 1e-30;
  E[6] = 1e30;
  RadiosityReport report, alone;
  const Solution s = solved(side_by_side(cube(), cube()), grey(rho), grey(E), report);
  const Solution one = solved(cube(), grey(rho.head(6)), grey(E.head(6) * 1e30), alone);
  EXPECT_EQ(report.systems, 2);
  for (Eigen::Index e = 0; e < 6; ++e) {
    EXPECT_NEAR(s.radiosity(e, 0) * 1e30, one.radiosity(e, 0), 1e-9 * one.radiosity(e, 0));
    EXPECT_NEAR(s.radiosity(e + 6, 0) * 1e-30, one.radiosity(e, 0), 1e-9 * one.radiosity(e, 0));
  }
}

TEST(Radiosity, ScalesWithTheLightWhateverItsSize) {
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(6);
  E[2] = 1;
  const ChannelArray rho = grey(Eigen::ArrayXd::LinSpaced(6, 0.1, 0.99));
  RadiosityReport report;
  const Solution one = solved(cube(), rho, grey(E), report);
  for (const int exponent : {-900, -500, 500, 900}) {
    const double factor = std::ldexp(1., exponent);
    const Solution s = solved(cube(), rho, grey(E * factor), report);
    EXPECT_EQ((s.radiosity / factor - one.radiosity).abs().maxCoeff(), 0) << exponent;
    EXPECT_TRUE(report.converged);
  }
  EXPECT_THROW(
      solved(cube(), grey(Eigen::ArrayXd::Constant(6, 1 - 1e-12)), grey(E * 1e300), report), Error)
      << "the radiosity would be infinite";
}

TEST(Radiosity, NearlyPerfectReflectorsAreAsExactAsOthers) {
  for (const double absorbed : {1e-6, 1e-9, 1e-12, 1e-15}) {
    const double rho = 1 - absorbed;
    RadiosityReport report;
    Eigen::ArrayXd E = Eigen::ArrayXd::Zero(6);
    E[1] = 6;
    const Solution s = solved(cube(), grey(Eigen::ArrayXd::Constant(6, rho)), grey(E), report,
                              {.tolerance = 1e-12});
    // The mean irradiance is Φ/(A (1 − ρ)), and B varies by no more than a few E.
    EXPECT_NEAR(s.irradiance.col(0).mean() * (1 - rho), 1, 1e-11) << absorbed;
    EXPECT_LE(s.radiosity.col(0).maxCoeff() - s.radiosity.col(0).minCoeff(), 20 + 1e-12 / absorbed);
    EXPECT_LE(report.channel[0].balance, 1e-11);
    EXPECT_LE(report.channel[0].error, 1e-9);
    // The white furnace with different reflectances, all but one of them nearly 1.
    Eigen::ArrayXd mixed = Eigen::ArrayXd::Constant(6, rho);
    mixed[3] = 1;
    mixed[4] = 1 - 100 * absorbed;
    const Solution furnace = solved(cube(), grey(mixed), 1 - grey(mixed), report);
    EXPECT_LE((furnace.radiosity - 1).abs().maxCoeff(), 1e-9) << absorbed;
  }
}

TEST(Radiosity, WhereNothingIsLostTheSmallestSolutionIsTaken) {
  // Emission that sums to zero, which only a caller of the library can ask for.
  Eigen::ArrayXd E(6);
  E << 1, -1, 2, -2, 0.5, -0.5;
  RadiosityReport report;
  const ChannelArray ones = grey(Eigen::ArrayXd::Ones(6));
  const Solution s = solved(cube(), ones, grey(E), report, {.tolerance = 1e-13});
  EXPECT_NEAR(s.radiosity.col(0).sum(), 0, 1e-12);
  const Eigen::VectorXd B = s.radiosity.col(0).matrix();
  EXPECT_LE((B - E.matrix() - cube().matrix * B).lpNorm<Eigen::Infinity>(), 1e-11);
}

TEST(Radiosity, TheErrorHoldsTheResidualTimesItsAmplification) {
  // Two rooms with a narrow door: the slow mode is their difference.
  const double door = 1e-4;
  Eigen::MatrixXd M = Eigen::MatrixXd(side_by_side(cube(), cube()).matrix);
  M(0, 6) = M(6, 0) = door;
  const Exchange rooms = make_exchange(M, M.rowwise().sum().array());
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(12);
  E[1] = 1;
  const ChannelArray rho = grey(Eigen::ArrayXd::Constant(12, 1 - 1e-6));
  RadiosityReport report;
  const Solution exact = solved(rooms, rho, grey(E), report, {.tolerance = 1e-15});
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const Solution s = solved(rooms, rho, grey(E), report, {.tolerance = tolerance});
    const double error =
        (s.irradiance - exact.irradiance).matrix().norm() / exact.irradiance.matrix().norm();
    EXPECT_GE(1.5 * report.channel[0].error + 1e-12, error) << tolerance;
  }
}

TEST(Radiosity, TwoPlatesAreTheGeometricSeries) {
  // One element each: B = E/(1 − (ρF)²) on the one that emits, and all that is lost is what F
  // lacks.
  for (const double F : {0.2, 0.998, 0.99999, 1 - 1e-9})
    for (const double rho : {0.5, 0.999, 1.}) {
      Eigen::Matrix2d M;
      M << 0, F, F, 0;
      Exchange plates = make_exchange(M, Eigen::Array2d(1, 1));
      plates.lost = Eigen::Array2d::Constant(1 - F);
      plates.enclosures.closed = {false};
      RadiosityReport report;
      const Solution s = solved(plates, grey(Eigen::Array2d::Constant(rho)),
                                grey(Eigen::Array2d(1, 0)), report, {.tolerance = 1e-13});
      const double loss = (1 - rho) + rho * (1 - F);  // 1 − ρF without cancellation
      EXPECT_NEAR(s.radiosity(0, 0) * loss * (2 - loss), 1, 1e-9) << F << ' ' << rho;
      EXPECT_NEAR(report.channel[0].absorbed_power + report.channel[0].escaped_power, 1, 1e-9);
    }
}

}  // namespace
}  // namespace halfshade
