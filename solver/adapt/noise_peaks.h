#pragma once

#include "solver/adapt/noisy_element.h"

#include <span>
#include <vector>

namespace halfshade {

/// No light counts as more uneven than this.
constexpr double most_peaks = 10;

/// The root mean square of the values where they are positive, relative to their mean there, from 1
/// to most_peaks: what is off is judged by the one, noise by the other.
double peaks_of(std::span<const NoisyElement> elements);

/// Places that tell light roughly, and the areas that they stand for.
struct PeakPlaces {
  std::vector<FieldPoint> points;
  std::vector<double> area;
};

/// About `count` ≥ 1 of them: half by area, half by the square of what light may be there.
PeakPlaces peak_places(std::span<const NoisyElement> elements, int count);

/// What they tell.
struct FirstLook {
  double peaks = 1;  ///< see peaks_of
  double noise = 0;  ///< ∫ of it, and of the square of light
  double square = 0;
};
FirstLook first_look(const PeakPlaces& places, std::span<const NoisyValue> values);

}  // namespace halfshade
