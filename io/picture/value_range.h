#pragma once

#include <optional>
#include <vector>

namespace halfshade {

enum class ValueScale { linear, log };

struct ValueRange {
  double low = 0, high = 1;  ///< low < high; both above zero on a logarithmic scale
};

/// A range for what is seen that single values far off do not stretch: from the 1st to the 99th
/// percentile; from 0 where nothing is negative and the lowest is small, and over no more than six
/// decades on a logarithmic scale. All values if they are whole. Not empty, whatever the values
/// are; those that are not finite are left out.
ValueRange robust_range(std::vector<double> values, ValueScale scale, bool is_whole = false);

/// The same for differences, with zero in the middle.
ValueRange robust_difference_range(std::vector<double> differences);

/// Where a value lies in a range, 0 to 1 inside; NaN for a value without a place.
double share_in(const ValueRange& range, ValueScale scale, double value);

}  // namespace halfshade
