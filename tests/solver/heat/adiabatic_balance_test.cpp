#include "solver/heat/adiabatic_balance.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const std::vector<Band> four = {
    {"a", true, 0, 2}, {"b", true, 2, 5}, {"c", true, 5, 12}, {"d", true, 12, HUGE_VAL}};

/// What is absorbed less what is sent out, as the header has it.
Eigen::ArrayXd imbalance(const AdiabaticBalance& balance, const Eigen::ArrayXd& kelvin) {
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(kelvin.size());
  for (Eigen::Index i = 0; i < kelvin.size(); ++i)
    for (Eigen::Index k = 0; k < balance.rest.size(); ++k) {
      double irradiance = balance.arriving(i, k);
      for (Eigen::Index j = 0; j < kelvin.size(); ++j)
        irradiance += balance.response[static_cast<std::size_t>(k)](i, j) *
                      balance.emissivity(j, k) *
                      (blackbody_exitance(kelvin[j], four)[k] - balance.rest[k]);
      result[i] += balance.emissivity(i, k) * (irradiance - blackbody_exitance(kelvin[i], four)[k]);
    }
  return result;
}

TEST(AdiabaticBalance, HoldsAtWhatIsFound) {
  test::Random random(5);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Index faces = 1 + round % 7;
    AdiabaticBalance balance;
    balance.rest =
        round % 2 == 0 ? Eigen::ArrayXd(Eigen::ArrayXd::Zero(4)) : blackbody_exitance(300, four);
    balance.emissivity.resize(faces, 4);
    balance.arriving.resize(faces, 4);
    balance.response.assign(4, Eigen::MatrixXd(faces, faces));
    for (Eigen::Index i = 0; i < faces; ++i) {
      const double kelvin = random(200, 3000);
      for (Eigen::Index k = 0; k < 4; ++k) {
        balance.emissivity(i, k) = random(0.01, 1);
        balance.arriving(i, k) =
            balance.rest[k] + random(0, 1) * blackbody_exitance(kelvin, four)[k];
        for (Eigen::Index j = 0; j < faces; ++j)
          balance.response[static_cast<std::size_t>(k)](i, j) =
              random(0, 0.9 / static_cast<double>(faces));
      }
    }
    const Eigen::ArrayXd kelvin = balanced_temperatures(balance, four);
    const double sent = stefan_boltzmann * std::pow(kelvin.maxCoeff(), 4);
    EXPECT_LT(imbalance(balance, kelvin).abs().maxCoeff(), 1e-12 * sent) << round;
    EXPECT_GT(kelvin.minCoeff(), 0);
  }
}

TEST(AdiabaticBalance, OfNothingIsCold) {
  AdiabaticBalance balance;
  balance.rest = Eigen::ArrayXd::Zero(4);
  balance.arriving = Eigen::ArrayXXd::Zero(2, 4);
  balance.emissivity = Eigen::ArrayXXd::Constant(2, 4, 0.5);
  balance.response.assign(4, Eigen::MatrixXd::Zero(2, 2));
  EXPECT_TRUE((balanced_temperatures(balance, four) == 0).all());
  balance.arriving.row(0) = blackbody_exitance(700, four).transpose();
  const Eigen::ArrayXd one = balanced_temperatures(balance, four);
  EXPECT_NEAR(one[0], 700, 1e-9);
  EXPECT_LT(one[1], 1e-6);
  balance.emissivity.row(1).setZero();
  EXPECT_TRUE(std::isnan(balanced_temperatures(balance, four)[1]));
}

}  // namespace
}  // namespace halfshade
