#include "io/picture/value_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr double few = 0.01;  ///< the share of values beyond either end
/// Ranges that begin this low, relative to their end, begin at zero.
constexpr double low_begin = 0.25;
constexpr double most_decades = 1e6;
/// Where all values are one, a logarithmic scale still takes a decade.
constexpr double least_ratio = 1.01;

/// A quantile of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(place))];
}

ValueRange linear_range(double low, double high) {
  if (low >= 0 && low < low_begin * high) low = 0;
  if (high > low) return {low, high};
  if (low == 0) return {0, 1};
  return low > 0 ? ValueRange{0, low} : ValueRange{low, 0};
}

ValueRange log_range(double low, double high) {
  if (!(low < high / least_ratio)) return {high / 10, high};
  return {std::max(low, high / most_decades), high};
}

ValueRange whole_range(double low, double high) {
  return high > low ? ValueRange{low, high} : ValueRange{low - 0.5, low + 0.5};
}

}  // namespace

ValueRange robust_range(std::vector<double> values, ValueScale scale, bool is_whole) {
  const bool is_log = scale == ValueScale::log;
  std::erase_if(values, [is_log](double v) { return !std::isfinite(v) || (is_log && !(v > 0)); });
  if (values.empty()) return is_log ? ValueRange{0.1, 1} : ValueRange{0, 1};
  std::sort(values.begin(), values.end());
  if (is_log) return log_range(quantile(values, few), quantile(values, 1 - few));
  if (is_whole) return whole_range(values.front(), values.back());
  return linear_range(quantile(values, few), quantile(values, 1 - few));
}

ValueRange robust_difference_range(std::vector<double> differences) {
  for (double& difference : differences) difference = std::abs(difference);
  std::erase_if(differences, [](double v) { return !std::isfinite(v); });
  std::sort(differences.begin(), differences.end());
  double most = differences.empty() ? 0 : quantile(differences, 1 - few);
  if (most == 0 && !differences.empty()) most = differences.back();
  return most > 0 ? ValueRange{-most, most} : ValueRange{-1, 1};
}

double share_in(const ValueRange& range, ValueScale scale, double value) {
  if (scale == ValueScale::linear) return (value - range.low) / (range.high - range.low);
  if (std::isnan(value)) return value;
  if (!(value > 0)) return -std::numeric_limits<double>::infinity();
  return std::log(value / range.low) / std::log(range.high / range.low);
}

}  // namespace halfshade
