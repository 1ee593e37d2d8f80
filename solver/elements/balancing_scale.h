#pragma once

namespace halfshade {

/// Power of two that brings the largest size to between one half and one, so that squares neither
/// overflow nor vanish; 1 if all are zero.
double balancing_scale(double largest);

}  // namespace halfshade
