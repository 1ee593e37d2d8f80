#pragma once

#include <array>
#include <cstdint>

namespace halfshade {

/// How many dimensions there are.
inline constexpr int sobol_dimensions = 4;

/// A coordinate of a point of Sobol's sequence (1967; directions of Joe and Kuo 2008), times 2^32.
/// `dimension` counts from 0 to sobol_dimensions − 1.
std::uint32_t sobol_bits(int dimension, std::uint32_t index);

/// Permutes the numbers below 2^32 such that each bit depends on the higher ones alone (Owen 1995,
/// by the hash of Burley 2020): points stay as evenly spread as they are, and each of them comes to
/// lie anywhere. The same for equal arguments.
std::uint32_t owen_scrambled(std::uint32_t bits, std::uint32_t seed);

/// The middle of the cell in [0, 1) that 32 bits stand for.
constexpr double unit_number(std::uint32_t bits) { return (bits + 0.5) * 0x1p-32; }

/// The sequence with every coordinate scrambled by itself. Points 0 … 2^k − 1 of a seed are spread
/// evenly over the cube; those of different seeds are independent.
class ScrambledSobol {
 public:
  explicit ScrambledSobol(std::uint64_t seed);

  std::array<double, sobol_dimensions> point(std::uint32_t index) const;

 private:
  std::array<std::uint32_t, sobol_dimensions> seeds_;
};

}  // namespace halfshade
