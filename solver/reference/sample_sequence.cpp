#include "solver/reference/sample_sequence.h"

#include "meshing/geometry/mix_bits.h"

namespace halfshade {
namespace {

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ff) << 8) | ((x & 0xff00ff00) >> 8);
  x = ((x & 0x0f0f0f0f) << 4) | ((x & 0xf0f0f0f0) >> 4);
  x = ((x & 0x33333333) << 2) | ((x & 0xcccccccc) >> 2);
  return ((x & 0x55555555) << 1) | ((x & 0xaaaaaaaa) >> 1);
}

/// A permutation in which every bit depends on the lower ones only (Laine and Karras 2011, with
/// Vegdahl's constants): on reversed bits, Owen's scrambling.
constexpr std::uint32_t permuted(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  return reversed(permuted(reversed(x), seed));
}

/// The second dimension of Sobol's sequence; the first is the reversed index.
constexpr std::uint32_t second_sobol(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1)
    if (index & 1u) result ^= column;
  return result;
}

double unit(std::uint32_t x) { return (x + 0.5) * 0x1p-32; }

}  // namespace

Vec2 SampleNumbers::pair(std::uint32_t use) const {
  const std::uint64_t key = mix_bits(seed_ + (use + std::uint64_t{1}) * splitmix_step);
  const std::uint64_t more = mix_bits(key);
  const std::uint32_t index = scrambled(sample_, static_cast<std::uint32_t>(key));
  return {unit(scrambled(reversed(index), static_cast<std::uint32_t>(key >> 32))),
          unit(scrambled(second_sobol(index), static_cast<std::uint32_t>(more)))};
}

}  // namespace halfshade
