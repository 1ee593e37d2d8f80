#pragma once

#include "meshing/core/types.h"

#include <cstdint>

namespace halfshade {

/// The numbers in [0, 1) that one sample of an integral of many dimensions uses: scrambled Sobol
/// points, shuffled anew for each use (Owen 1995, by the hashes of Burley 2020). The samples 0 …
/// 2^k − 1 of one seed are spread evenly over each square; samples of different seeds, and pairs of
/// different uses, are independent. Everything follows from seed and sample alone.
class SampleNumbers {
 public:
  SampleNumbers(std::uint64_t seed, std::uint32_t sample) : seed_(seed), sample_(sample) {}

  double number(std::uint32_t use) const { return pair(use).x(); }
  Vec2 pair(std::uint32_t use) const;

 private:
  std::uint64_t seed_;
  std::uint32_t sample_;
};

}  // namespace halfshade
