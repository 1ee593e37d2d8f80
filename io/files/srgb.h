#pragma once

#include <cmath>

namespace halfshade::detail {

/// Display values in [0, 1] for linear ones and back, IEC 61966-2-1.
inline double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace halfshade::detail
