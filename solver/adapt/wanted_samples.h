#pragma once

#include "solver/adapt/noisy_element.h"

#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Places of elements that samples are to be taken at.
struct WantedSamples {
  std::vector<FieldPoint> points;
  std::vector<double> slack;  ///< how many times as noisy as usual each may be
  std::vector<TrianglePlace> places;
  std::vector<int> elements;       ///< that lack some, or are not fitted
  std::vector<std::size_t> first;  ///< of each of them, and an end
};

/// Those that elements lack; any may be `noise` times as noisy as its element lets it.
WantedSamples wanted_samples(std::span<const NoisyElement> elements, double noise);

/// Points and slack of every so many, `count` of them, at most all.
WantedSamples some_of(const WantedSamples& all, std::size_t count);

}  // namespace halfshade
