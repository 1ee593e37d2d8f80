#include "solver/reflected/stagnation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

namespace halfshade {
namespace {

TEST(Stagnation, IsNoneWhereErrorsFallHoweverSlowly) {
  EXPECT_FALSE(is_stagnant({}));
  for (const double rate : {0.5, 1.5}) {
    std::vector<RoundError> rounds;
    for (int n = 100; n < 100000; n *= 2) {
      rounds.push_back({n, std::pow(n, -rate)});
      EXPECT_FALSE(is_stagnant(rounds)) << n;
    }
  }
}

TEST(Stagnation, IsToldByEightTimesTheElements) {
  std::vector<RoundError> rounds = {{100, 0.5}, {200, 0.04}, {400, 0.035}, {800, 0.033}};
  EXPECT_FALSE(is_stagnant(rounds));
  rounds.push_back({1700, 0.032});
  EXPECT_TRUE(is_stagnant(rounds));
  rounds.back().error = 0.02;
  EXPECT_FALSE(is_stagnant(rounds));
}

TEST(Stagnation, WhatIsNotKnownFallsIfThreeRoundsLeaveHalf) {
  const std::vector<double> unknown = {8, 9, 6, 5, 4, 3.1, 2};
  const std::vector<bool> expected = {true, true, true, true, false, true, false, true};
  for (std::size_t n = 0; n <= unknown.size(); ++n)
    EXPECT_EQ(is_falling(std::span(unknown).first(n)), expected[n]) << n;
}

}  // namespace
}  // namespace halfshade
