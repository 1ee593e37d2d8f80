#include "solver/adapt/sample_forecast.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

TEST(SampleForecast, FindsWhereAPowerLawEnds) {
  const auto square_error = [](double samples) { return 3e5 / std::pow(samples, 1.5); };
  SampleForecast forecast;
  EXPECT_FALSE(forecast.in_the_end(100, square_error(100)));
  for (const double samples : {150., 700.})
    EXPECT_NEAR(*forecast.in_the_end(samples, square_error(samples)), std::pow(3e5, 1 / 1.5), 1e-6);
}

TEST(SampleForecast, KnowsNothingOfErrorsThatDoNotFall) {
  SampleForecast forecast;
  forecast.in_the_end(100, 5);
  EXPECT_FALSE(forecast.in_the_end(200, 6));
  EXPECT_TRUE(forecast.in_the_end(300, 5));
  EXPECT_FALSE(forecast.in_the_end(300, 4));  // no more samples
}

}  // namespace
}  // namespace halfshade
