#pragma once

#include <utility>

namespace halfshade {

/// The place of cell (x, y) of a square of side² on Hilbert's curve, which goes from cell to
/// neighbouring cell: what is close on it lies close together. `side` is a power of two.
constexpr int place_on_hilbert_curve(int side, int x, int y) {
  int place = 0;
  for (int s = side / 2; s > 0; s /= 2) {
    const bool right = (x & s) != 0, up = (y & s) != 0;
    place += s * s * ((right ? 3 : 0) ^ (up ? 1 : 0));
    if (up) continue;
    if (right) {
      x = side - 1 - x;
      y = side - 1 - y;
    }
    std::swap(x, y);
  }
  return place;
}

}  // namespace halfshade
