#pragma once

#include "solver/adapt/field_beginnings.h"
#include "solver/adapt/noisy_element.h"

#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Places on elements that their polynomials do not know.
struct FreshPlaces {
  std::vector<FieldPoint> points;
  std::vector<std::size_t> element;
  std::vector<TrianglePlace> place;  ///< in it
  std::vector<double> area;          ///< that each stands for
};

/// About `count` of them: half are drawn where the error is thought to be, whose square is
/// `expected` in all, and half elsewhere: by area, where elements count, and by the square of what
/// light may be there, which bounds what one place can add. They go on from the samples of each
/// element; `draw` decides which have one more or less.
FreshPlaces fresh_places(std::span<const NoisyElement> elements,
                         const AdaptiveFieldOptions& options, double expected, double count,
                         std::uint64_t draw);

/// What such places tell of the square of the error, in all: the product of what two values at a
/// place are off, each with noise of its own, is right in the mean.
class SquareError {
 public:
  /// Of as many places as before, each time. The samples go to the elements, whose polynomials stay
  /// as they are.
  void add(const FreshPlaces& places, std::span<const NoisyValue> values,
           std::span<NoisyElement> elements);

  int count() const { return count_; }  ///< of what was added
  double mean() const { return sum_ / count_; }
  /// Standard deviation of that. How many places there are is random, too: nothing is known of the
  /// mean beforehand.
  double deviation() const;

 private:
  int count_ = 0;
  double sum_ = 0, sum_of_squares_ = 0;
};

}  // namespace halfshade
