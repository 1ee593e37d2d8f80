#pragma once

#include "meshing/core/types.h"

#include <span>

namespace halfshade {

/// Power of two that brings the largest size to between one half and one, so that squares neither
/// overflow nor vanish; 1 if all are zero.
double balancing_scale(double largest);

/// One for each channel of values ≥ 0: that of the strongest channel, but larger for a channel so
/// weak that it counts in no sum, so that nothing of it vanishes. The least is the scale of sums
/// over the channels.
Rgb balancing_scale(std::span<const Rgb> values);

}  // namespace halfshade
