#pragma once

#include <cstdint>

namespace halfshade {

/// What the state of splitmix64 grows by: mix_bits of 0, 1, 2, … times this is its sequence.
inline constexpr std::uint64_t splitmix_step = 0x9e3779b97f4a7c15;

/// A bijection of 64 bits in which every bit of the result depends on every bit of x (Steele, Lea
/// and Flood's splitmix64, 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += splitmix_step;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// The upper bits as a number from 0 to less than 1.
constexpr double unit_share(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace halfshade
