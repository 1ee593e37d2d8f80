#include "solver/heat/emission.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

std::vector<Band> two(double a, double b, double c, double d) {
  return {{"a", true, a, b}, {"b", true, c, d}};
}

TEST(Emission, TellsTheTemperatureInAnyBands) {
  const Eigen::Array2d emissivity(0.3, 0.8);
  int told = 0;
  for (const std::vector<Band>& bands :
       {two(3, 3.0001, 10, 10.001), two(.4, .5, .5, .7), two(1e6, 1e7, 1e7, HUGE_VAL),
        two(0, 1, 1e5, HUGE_VAL), two(8, 12, 12, HUGE_VAL), two(3, 3.0000001, 1e4, 1e4 + 1)})
    for (const double kelvin : {1e-3, 1., 30., 300., 900., 6000., 1e6})
      for (const double start : {0., 1e-3, 300., 1e8}) {
        const double power = emission_at(kelvin, emissivity, bands).power.sum();
        const double found = emission_temperature(power, emissivity, bands, start);
        if (power < weakest_part) {
          EXPECT_EQ(found, 0) << kelvin;
          continue;
        }
        EXPECT_NEAR(found, kelvin, 1e-13 * kelvin) << bands[0].longest << " " << start;
        ++told;
      }
  EXPECT_GT(told, 100);
}

TEST(Emission, GrowsAsItsDifferencesDo) {
  const Eigen::Array2d emissivity(0.3, 0.8);
  const std::vector<Band> bands = two(.4, .5, 3, 3.0001);
  for (const double kelvin : {100., 900., 1e5}) {
    const double h = 1e-5;
    const Eigen::ArrayXd expected = (emission_at(kelvin * (1 + h), emissivity, bands).power -
                                     emission_at(kelvin * (1 - h), emissivity, bands).power) /
                                    (2 * h);
    const Eigen::ArrayXd growth = emission_at(kelvin, emissivity, bands).growth;
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(growth[k], expected[k], 1e-5 * expected[k]);
  }
}

TEST(Emission, OfWhatNothingSendsHasNoTemperature) {
  const std::vector<Band> bands = two(3, 4, 5, 6);
  EXPECT_TRUE(std::isnan(emission_temperature(9, Eigen::Array2d::Zero(), bands)));
  EXPECT_TRUE(std::isnan(emission_temperature(1e100, Eigen::Array2d::Ones(), bands)));
  EXPECT_EQ(emission_temperature(0, Eigen::Array2d::Ones(), bands), 0);
}

}  // namespace
}  // namespace halfshade
