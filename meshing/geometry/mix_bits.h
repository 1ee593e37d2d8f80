#pragma once

#include <cstdint>

namespace halfshade {

/// A bijection of 64 bits in which every bit of the result depends on every bit of x (Steele, Lea
/// and Flood's splitmix64, 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace halfshade
