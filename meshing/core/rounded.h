#pragma once

#include <bit>
#include <cstdint>

namespace halfshade {

/// x to some binary digits; to 30 that is relatively to 1e-9. What is equal but for rounding, such
/// as the sides of a symmetric triangle or the errors of two halves of a room, is so in it, and
/// other units of length round it no other way: what is compared by it falls to numbers of things,
/// which do not change. Two values lie on both sides of where it steps as often as a rounding is of
/// 1e-9, so that of values known less well fewer digits do.
template <int digits = 30>
constexpr double rounded(double x) {
  constexpr int dropped = 53 - digits;
  constexpr std::uint64_t half = std::uint64_t{1} << (dropped - 1), unit = 2 * half;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + half) & ~(unit - 1));
}

}  // namespace halfshade
