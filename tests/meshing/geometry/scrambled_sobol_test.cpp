#include "meshing/geometry/scrambled_sobol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// Boost's points come in another order, the same ones up to every power of two, without the first.
TEST(ScrambledSobol, HasThePointsOfBoost) {
  constexpr int count = 1 << 10;
  std::vector<std::array<std::uint32_t, sobol_dimensions>> ours, theirs;
  boost::random::sobol engine(sobol_dimensions);
  for (std::uint32_t i = 1; i < count; ++i) {
    ours.emplace_back();
    theirs.emplace_back();
    for (int d = 0; d < sobol_dimensions; ++d) {
      ours.back()[static_cast<std::size_t>(d)] = sobol_bits(d, i);
      theirs.back()[static_cast<std::size_t>(d)] = static_cast<std::uint32_t>(engine() >> 32);
    }
  }
  std::sort(ours.begin(), ours.end());
  std::sort(theirs.begin(), theirs.end());
  EXPECT_EQ(ours, theirs);
}

TEST(ScrambledSobol, HasOnePointInEachPartOfEachSide) {
  constexpr std::size_t count = 1 << 12;
  for (const std::uint64_t seed : {0u, 1u, 77u})
    for (std::size_t d = 0; d < sobol_dimensions; ++d) {
      const ScrambledSobol sequence(seed);
      std::vector<int> in_part(count);
      for (std::uint32_t i = 0; i < count; ++i)
        ++in_part[static_cast<std::size_t>(sequence.point(i)[d] * count)];
      EXPECT_EQ(in_part, std::vector<int>(count, 1)) << seed << ' ' << d;
    }
}

/// A ball of four dimensions, with a jump all round it: independent points would be off by 8e-3.
TEST(ScrambledSobol, IntegratesWhatJumps) {
  constexpr int count = 1 << 12, seeds = 50;
  const double part_of_ball = std::pow(std::numbers::pi, 2) / 32;
  double sum = 0, squares = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const ScrambledSobol sequence(seed);
    int inside = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      double r2 = 0;
      for (const double x : sequence.point(i)) r2 += x * x;
      inside += r2 < 1 ? 1 : 0;
    }
    const double off = static_cast<double>(inside) / count - part_of_ball;
    sum += off;
    squares += off * off;
  }
  const double deviation = std::sqrt(squares / seeds);
  EXPECT_LT(deviation, 3e-3);
  EXPECT_LT(std::abs(sum / seeds), 3 * deviation / std::sqrt(seeds)) << "no seed's own error";
}

}  // namespace
}  // namespace halfshade
