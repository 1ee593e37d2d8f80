#include "solver/heat/heat.h"

#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <numbers>

namespace halfshade {
namespace {

/// 15/π⁴ ∫ t³/(eᵗ − 1) from c₂/(λT) on, by Simpson's rule in the variable that makes it finite.
double planck_share(double product) {
  const double from = 14387.768775039337 / product, to = from + 60;
  constexpr int intervals = 200000;
  const double h = (to - from) / intervals;
  double sum = 0;
  for (int k = 0; k <= intervals; ++k) {
    const double t = from + k * h;
    sum += (k == 0 || k == intervals ? 1 : k % 2 == 1 ? 4 : 2) * t * t * t / std::expm1(t);
  }
  return 15 / std::pow(std::numbers::pi, 4) * sum * h / 3;
}

TEST(Heat, SharesOfBlackBodiesAreThoseOfPlancksLaw) {
  for (const double product : {500., 1000., 2897.77, 5000., 14000., 14500., 20000., 1e5})
    EXPECT_NEAR(blackbody_share_below(product / 700, 700), planck_share(product), 1e-12) << product;
  EXPECT_EQ(blackbody_share_below(0, 300), 0);
  EXPECT_EQ(blackbody_share_below(3, 0), 0);
  EXPECT_EQ(blackbody_share_below(HUGE_VAL, 300), 1);
  EXPECT_NEAR(blackbody_share_below(1e6, 300), 1, 1e-14);
}

TEST(Heat, BandsShareWhatABlackBodySends) {
  const double all = stefan_boltzmann * 1e12;
  EXPECT_EQ(blackbody_exitance(1000, {})[0], all);
  const Band near{"near", true, 0, 3}, far{"far", true, 3, HUGE_VAL}, unknown{"one"};
  EXPECT_EQ(blackbody_exitance(1000, {unknown})[0], all);
  const Eigen::ArrayXd two = blackbody_exitance(1000, {near, far});
  EXPECT_NEAR(two[0] + two[1], all, 1e-14 * all);
  EXPECT_NEAR(two[0], all * blackbody_share_below(3, 1000), 1e-14 * all);
  EXPECT_EQ(blackbody_exitance(1000, {near}).size(), 1);
  EXPECT_NEAR(blackbody_temperature(all), 1000, 1e-12);
}

TEST(Heat, SlopesOfBandsAreTheirDerivatives) {
  const std::vector<Band> bands = {
      {"a", true, 0, 2}, {"b", true, 2, 5}, {"c", true, 7, 50}, {"d", true, 50, HUGE_VAL}};
  for (const double kelvin : {40., 300., 1500., 6000.}) {
    const double h = 1e-4 * kelvin;
    const Eigen::ArrayXd expected =
        (blackbody_exitance(kelvin + h, bands) - blackbody_exitance(kelvin - h, bands)) / (2 * h);
    const Eigen::ArrayXd slope = blackbody_slope(kelvin, bands);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(slope[k], expected[k], 1e-6 * slope.sum()) << kelvin << " " << k;
    EXPECT_DOUBLE_EQ(blackbody_slope(kelvin, {})[0], 4 * stefan_boltzmann * std::pow(kelvin, 3));
  }
}

TEST(Heat, BandsAreChannelsAsFarAsTheyGo) {
  EXPECT_TRUE((to_channels(Eigen::ArrayXd::Constant(1, 4), 9) == Rgb(4, 4, 4)).all());
  EXPECT_TRUE((to_channels(Eigen::Array2d(4, 5), 9) == Rgb(4, 5, 0)).all());
  EXPECT_TRUE((to_channels(Eigen::Array3d(4, 5, 6), 9) == Rgb(4, 5, 6)).all());
  EXPECT_TRUE((to_channels(Eigen::Array4d(4, 5, 6, 7), 9) == Rgb(9, 9, 9)).all());
}

TEST(Heat, IsBalancedOverBandsAndOverSides) {
  std::vector<Material> materials(2);
  materials[1].two_sided = true;
  Heat heat;
  EXPECT_FALSE(balances_faces(heat, materials));
  heat.materials.resize(2);
  EXPECT_FALSE(balances_faces(heat, materials));
  heat.materials[0].is_adiabatic = true;
  EXPECT_FALSE(balances_faces(heat, materials));
  heat.materials[1].is_adiabatic = true;
  EXPECT_FALSE(is_balanced(heat, materials, 0));
  EXPECT_TRUE(is_balanced(heat, materials, 1));
  heat.bands = {{"near", true, 0, 3}, {"far", true, 3, HUGE_VAL}};
  EXPECT_TRUE(is_balanced(heat, materials, 0));
}

TEST(Heat, HasToComeFromSomewhere) {
  Scene scene;
  scene.source = "cold.obj";
  scene.materials.resize(1);
  scene.faces.push_back({{0, 1, 2}, 0, 0});
  Heat heat;
  test::expect_error([&] { require_heat(scene, heat); }, ErrorCode::invalid_input,
                     {"cold.obj", "'temperature'", "--surroundings"});
  heat.surroundings = 0;
  EXPECT_THROW(require_heat(scene, heat), Error);
  heat.surroundings = 3;
  EXPECT_NO_THROW(require_heat(scene, heat));
  heat.surroundings.reset();
  scene.materials[0].exitance.setOnes();
  EXPECT_NO_THROW(require_heat(scene, heat));
}

TEST(Heat, UnitsOfLengthAreKnownByNameAndSign) {
  EXPECT_EQ(metres_in("m"), 1);
  EXPECT_EQ(metres_in("mm"), 1e-3);
  EXPECT_EQ(metres_in("inch"), 0.0254);
  EXPECT_FALSE(metres_in("furlong"));
}

}  // namespace
}  // namespace halfshade
