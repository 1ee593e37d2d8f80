#include "solver/adapt/sample_forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

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

TEST(SampleForecast, TheRestTakesMoreOnceTwoCallsInARowSaySo) {
  const auto calls = [](double most, std::initializer_list<double> errors) {
    SampleForecast forecast;
    double samples = 1000;
    std::vector<bool> said;
    for (const double error : errors)
      said.push_back(forecast.rest_takes_more(most, samples *= 2, error * error));
    return said;
  };
  // Halved by twice the samples: from 8 with 2000 it takes 16000.
  EXPECT_EQ(calls(9000, {8, 4, 2, 1}), (std::vector<bool>{false, false, false, false}))
      << "12000 are to come after the second, but 8000 after the third";
  EXPECT_EQ(calls(3000, {8, 4, 2, 1.9}), (std::vector<bool>{false, false, true, true}));
  EXPECT_EQ(calls(1e5, {8, 7.9, 7.8, 7.7, 7.6}),
            (std::vector<bool>{false, false, false, false, true}))
      << "nothing is known before a tenth of that";
  EXPECT_EQ(calls(3000, {8, 9, 10}), (std::vector<bool>{false, false, true}))
      << "where errors grow as much is to come as there was";
}

}  // namespace
}  // namespace halfshade
