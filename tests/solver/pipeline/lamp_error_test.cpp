#include "solver/pipeline/lamp_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// One element with a right angle and legs of 2, irradiance 3 in all channels.
AdaptiveField even_light() {
  AdaptiveField light;
  light.elements.corners = {{0, 1, 2}};
  light.elements.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  light.elements.area = {2};
  light.field = zero_field({0});
  light.field.of(0).setConstant(3);
  light.error = Eigen::ArrayXd::Constant(1, 0.03);
  light.report.relative_error = 0.03 / std::sqrt(27.);
  return light;
}

TEST(LampErrorOfSolutions, AddsToTheErrorOfDirectLight) {
  AdaptiveField light = even_light();
  const double norm = std::sqrt(square_integral(light.field, light.elements));
  SolveOptions options;
  add_lamp_error(options, light);
  EXPECT_EQ(light.error[0], 0.03);
  EXPECT_EQ(share_beside_lamps(options), 1);
  options.lamp_error = 0.04 * std::sqrt(2.);
  EXPECT_LT(share_beside_lamps(options), 1);
  EXPECT_NEAR(relative_lamp_error(options, light.field, light.elements), options.lamp_error / norm,
              1e-12);
  const double before = light.report.relative_error;
  add_lamp_error(options, light);
  EXPECT_NEAR(light.error[0], 0.05, 1e-12);
  EXPECT_NEAR(light.report.relative_error, std::hypot(before, options.lamp_error / norm), 1e-12);
}

TEST(LampErrorOfSolutions, IsAnErrorWhereNoneWasFound) {
  AdaptiveField light = even_light();
  light.error.setZero();
  SolveOptions options;
  options.lamp_error = 0.1;
  add_lamp_error(options, light);
  EXPECT_NEAR(light.error[0], 0.1 / std::sqrt(2.), 1e-12);
}

}  // namespace
}  // namespace halfshade
