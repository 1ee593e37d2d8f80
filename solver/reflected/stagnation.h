#pragma once

#include <span>

namespace halfshade {

/// What a round of refinement came to.
struct RoundError {
  int elements = 0;
  double error = 0;
};

/// Whether more elements do not help: the last round has many times those of an earlier one, and
/// hardly less error. Of order 2 they leave some hundredths of it, and a third where light is as
/// rough as it gets. What stays is not of elements: surfaces that rounding put before or behind
/// each other, so that what they see is anything.
bool is_stagnant(std::span<const RoundError> rounds);

/// Whether what is not known, of each round so far, is at most half of what it was in one of the
/// last three. Nothing is known of that before there are as many.
bool is_falling(std::span<const double> unknown);

}  // namespace halfshade
