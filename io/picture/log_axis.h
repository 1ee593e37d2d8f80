#pragma once

#include <string>
#include <vector>

namespace halfshade::detail {

/// A logarithmic axis over a part of the screen.
struct LogAxis {
  double low = 0, high = 1;   ///< decimal logarithms
  double start = 0, end = 1;  ///< where they are drawn, pixels

  double at(double value) const;
};

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a line only
};

/// An axis that holds all values, with some room on either side; one decade round 1 if there are
/// none. Precondition: the values are finite and above zero.
LogAxis fitting_axis(const std::vector<double>& values, double start, double end);

/// A line at each 1, 2, …, 9 times a power of ten, and labels at powers of ten, or also at 2 and 5
/// times one where the axis is short (decades), or at every other where it is long.
std::vector<Tick> ticks(const LogAxis& axis, double short_axis = 1.6);

}  // namespace halfshade::detail
