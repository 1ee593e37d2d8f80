#include "meshing/geometry/scrambled_sobol.h"

#include "meshing/geometry/mix_bits.h"

#include <cstddef>

namespace halfshade {
namespace {

/// A dimension's primitive polynomial, and the first of its directions.
struct SobolStart {
  int degree;
  unsigned coefficients;  ///< those between the first and the last, which are 1
  std::array<std::uint32_t, 3> numbers;
};

using Directions = std::array<std::uint32_t, 32>;

constexpr Directions make_directions(const SobolStart& start) {
  Directions v{};
  const auto s = static_cast<std::size_t>(start.degree);
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (k < s) {
      v[k] = start.numbers[k] << (31 - k);
      continue;
    }
    v[k] = v[k - s] ^ (v[k - s] >> s);
    for (std::size_t j = 1; j < s; ++j)
      if ((start.coefficients >> (s - 1 - j)) & 1u) v[k] ^= v[k - j];
  }
  return v;
}

/// Of all dimensions but the first, whose coordinates are the index backwards.
constexpr std::array<Directions, sobol_dimensions - 1> directions{
    make_directions({1, 0, {1}}), make_directions({2, 1, {1, 3}}),
    make_directions({3, 1, {1, 3, 1}})};

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ff) << 8) | ((x & 0xff00ff00) >> 8);
  x = ((x & 0x0f0f0f0f) << 4) | ((x & 0xf0f0f0f0) >> 4);
  x = ((x & 0x33333333) << 2) | ((x & 0xcccccccc) >> 2);
  return ((x & 0x55555555) << 1) | ((x & 0xaaaaaaaa) >> 1);
}

/// A permutation in which every bit depends on the lower ones only (Laine and Karras 2011, with
/// Vegdahl's constants).
constexpr std::uint32_t permuted(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

}  // namespace

std::uint32_t sobol_bits(int dimension, std::uint32_t index) {
  if (dimension == 0) return reversed(index);
  const Directions& v = directions[static_cast<std::size_t>(dimension - 1)];
  std::uint32_t bits = 0;
  for (std::size_t k = 0; index != 0; ++k, index >>= 1)
    if (index & 1u) bits ^= v[k];
  return bits;
}

std::uint32_t owen_scrambled(std::uint32_t bits, std::uint32_t seed) {
  return reversed(permuted(reversed(bits), seed));
}

ScrambledSobol::ScrambledSobol(std::uint64_t seed) {
  std::uint64_t state = mix_bits(seed);
  for (std::uint32_t& own : seeds_) {
    own = static_cast<std::uint32_t>(mix_bits(state) >> 32);
    state += splitmix_step;
  }
}

std::array<double, sobol_dimensions> ScrambledSobol::point(std::uint32_t index) const {
  std::array<double, sobol_dimensions> point{};
  for (int d = 0; d < sobol_dimensions; ++d) {
    const auto k = static_cast<std::size_t>(d);
    point[k] = unit_number(owen_scrambled(sobol_bits(d, index), seeds_[k]));
  }
  return point;
}

}  // namespace halfshade
