#include "solver/reference/sample_sequence.h"

#include "meshing/geometry/mix_bits.h"
#include "meshing/geometry/scrambled_sobol.h"

namespace halfshade {

Vec2 SampleNumbers::pair(std::uint32_t use) const {
  const std::uint64_t key = mix_bits(seed_ + (use + std::uint64_t{1}) * splitmix_step);
  const std::uint64_t more = mix_bits(key);
  const std::uint32_t index = owen_scrambled(sample_, static_cast<std::uint32_t>(key));
  return {unit_number(owen_scrambled(sobol_bits(0, index), static_cast<std::uint32_t>(key >> 32))),
          unit_number(owen_scrambled(sobol_bits(1, index), static_cast<std::uint32_t>(more)))};
}

}  // namespace halfshade
