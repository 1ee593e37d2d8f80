#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade::test {

/// A value of Student's distribution as the one of the normal distribution that is as likely to be
/// exceeded (Wallace 1959, to 2e-3 for 20 and more degrees of freedom).
inline double normal_score(double t, double degrees) {
  const double shrink = (8 * degrees + 1) / (8 * degrees + 3);
  return std::copysign(shrink * std::sqrt(degrees * std::log1p(t * t / degrees)), t);
}

/// Expects errors divided by their standard errors, of batches − 1 degrees of freedom, to be
/// distributed as they should: mean, spread and the whole distribution (Kolmogorov and Smirnov), to
/// what one true sample in a hundred misses.
inline void expect_right_distribution(const std::vector<double>& errors, double degrees) {
  std::vector<double> z;
  for (const double t : errors) z.push_back(normal_score(t, degrees));
  std::sort(z.begin(), z.end());
  const auto n = static_cast<double>(z.size());
  double mean = 0, square = 0, distance = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    mean += z[i] / n;
    square += z[i] * z[i] / n;
    const double below = 0.5 * std::erfc(-z[i] / std::sqrt(2.));
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, below - rank / n, (rank + 1) / n - below});
  }
  EXPECT_LT(std::abs(mean), 2.6 / std::sqrt(n));
  EXPECT_LT(std::abs(square - 1), 2.6 * std::sqrt(2 / n));
  EXPECT_LT(distance, 1.63 / std::sqrt(n));
}

}  // namespace halfshade::test
