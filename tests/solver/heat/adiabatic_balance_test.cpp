#include "solver/heat/adiabatic_balance.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const std::vector<Band> four = {
    {"a", true, 0, 2}, {"b", true, 2, 5}, {"c", true, 5, 12}, {"d", true, 12, HUGE_VAL}};

/// What is absorbed less what is sent out, as the header has it.
Eigen::ArrayXd imbalance(const AdiabaticBalance& balance, const Eigen::ArrayXd& kelvin,
                         const std::vector<Band>& bands = four) {
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(kelvin.size());
  for (Eigen::Index i = 0; i < kelvin.size(); ++i)
    for (Eigen::Index k = 0; k < balance.rest.size(); ++k) {
      double irradiance = balance.arriving(i, k);
      for (Eigen::Index j = 0; j < kelvin.size(); ++j)
        irradiance += balance.response[static_cast<std::size_t>(k)](i, j) *
                      balance.emissivity(j, k) *
                      (blackbody_exitance(kelvin[j], bands)[k] - balance.rest[k]);
      result[i] +=
          balance.emissivity(i, k) * (irradiance - blackbody_exitance(kelvin[i], bands)[k]);
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

/// Faces of as much area each in a white cavity, of which a share of lamps is let in and as much
/// let out: as hot as the lamps are, if they are all as hot.
AdiabaticBalance random_balance(test::Random& random, const std::vector<Band>& bands,
                                Eigen::Index faces, double coldest, double hottest, double share) {
  const auto count = static_cast<Eigen::Index>(bands.size());
  AdiabaticBalance balance;
  balance.rest = Eigen::ArrayXd::Zero(count);
  balance.emissivity.resize(faces, count);
  balance.arriving.resize(faces, count);
  for (Eigen::Index i = 0; i < faces; ++i) {
    const double kelvin = coldest * std::pow(hottest / coldest, random(0, 1));
    balance.arriving.row(i) = share * blackbody_exitance(kelvin, bands).transpose();
    for (Eigen::Index k = 0; k < count; ++k) balance.emissivity(i, k) = std::pow(10, random(-2, 0));
  }
  for (Eigen::Index k = 0; k < count; ++k)
    balance.response.push_back(
        Eigen::MatrixXd::Constant(faces, faces, (1 - share) / balance.emissivity.col(k).sum()));
  return balance;
}

// Each face to its own power, not to that of the brightest.
TEST(AdiabaticBalance, HoldsInBandsThatHoldLittle) {
  const auto two = [](double a, double b, double c, double d) {
    return std::vector<Band>{{"a", true, a, b}, {"b", true, c, d}};
  };
  test::Random random(7);
  for (const std::vector<Band>& bands :
       {two(.4, .5, .5, .7), two(3, 3.0001, 10, 10.001), two(0, 1, 1e5, HUGE_VAL),
        two(.2, .3, 50, 50.01), two(1e3, 1e4, 1e5, 1e6)})
    for (const double scale : {1., 100.})
      for (const double share : {.5, 1e-2, 1e-5})
        for (const Eigen::Index faces : {1, 2, 7, 20}) {
          SCOPED_TRACE(testing::Message() << bands[0].shortest << " µm on, " << scale << ", "
                                          << share << ", " << faces << " faces");
          const double coldest = 200 * scale, hottest = 6000 * scale;
          const AdiabaticBalance balance =
              random_balance(random, bands, faces, coldest, hottest, share);
          const Eigen::ArrayXd kelvin = balanced_temperatures(balance, bands);
          const Eigen::ArrayXd off = imbalance(balance, kelvin, bands);
          for (Eigen::Index i = 0; i < faces; ++i) {
            EXPECT_GT(kelvin[i], coldest * .9999);
            EXPECT_LT(kelvin[i], hottest * 1.0001);
            double sent = 0;
            for (Eigen::Index k = 0; k < 2; ++k)
              sent += balance.emissivity(i, k) * blackbody_exitance(kelvin[i], bands)[k];
            EXPECT_LT(std::abs(off[i]), 1e-11 * sent) << i;
          }
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
