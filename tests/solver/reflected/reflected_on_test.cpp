#include "solver/reflected/reflected_on.h"

#include "tests/support/random.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// About normal, of deviation 1.
double noise(test::Random& random) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += random(-0.5, 0.5);
  return sum;
}

/// Six parts of something of length `length` in so many places, whose mean has noise of length
/// `noisy`.
ReflectedOn square_of(int places, double length, double noisy, test::Random& random) {
  Eigen::MatrixXd parts(6, places);
  for (int p = 0; p < parts.rows(); ++p)
    for (int i = 0; i < places; ++i)
      parts(p, i) = (length + noisy * std::sqrt(6.) * noise(random)) / std::sqrt(places);
  return square_of_mean(parts * parts.transpose());
}

struct Summary {
  double mean = 0, deviation = 0;
  double enough = 0;  ///< how often, as a share, no more was there than at most
};

Summary of_many(int places, double length, double noisy) {
  constexpr int times = 400;
  test::Random random(7);
  Summary all;
  for (int k = 0; k < times; ++k) {
    const ReflectedOn found = square_of(places, length, noisy, random);
    all.mean += found.square / times;
    all.deviation += found.deviation / times;
    if (length * length <= found.at_most()) all.enough += 1. / times;
  }
  return all;
}

TEST(ReflectedOn, HasNoBiasByNoise) {
  EXPECT_NEAR(of_many(300, 0, 1).mean, 0, 0.02);
  EXPECT_NEAR(of_many(300, 1, 1).mean, 1, 0.02);
  EXPECT_NEAR(of_many(1, 1, 0.5).mean, 1, 0.1);
}

TEST(ReflectedOn, ClaimsEnough) {
  for (const double noisy : {0.1, 0.5, 2.})
    for (const int places : {1, 10, 300})
      EXPECT_GE(of_many(places, 1, noisy).enough, 0.85) << places << " places, noise " << noisy;
}

/// In all it has a square of 1.
TEST(ReflectedOn, NoiseInManyPlacesCancels) {
  EXPECT_LT(of_many(300, 0, 1).deviation, 0.15);
  EXPECT_GT(of_many(1, 0, 1).deviation, 0.5) << "of one form it does not";
}

TEST(ReflectedOn, OfPartsThatAgreeIsSure) {
  const ReflectedOn sure = square_of_mean(Eigen::MatrixXd::Constant(6, 6, 4));
  EXPECT_DOUBLE_EQ(sure.square, 4);
  EXPECT_DOUBLE_EQ(sure.deviation, 0);
  EXPECT_DOUBLE_EQ(sure.at_most(), 4);
  EXPECT_DOUBLE_EQ((ReflectedOn{-1, 2}.at_most()), 4) << "there may be nothing but noise";
}

}  // namespace
}  // namespace halfshade
