#include "io/picture/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade::detail {
namespace {

std::string tick_label(double value) {
  const int power = static_cast<int>(std::floor(std::log10(value) + 0.01));
  if (power > -4 && power < 5) return fmt::format("{:g}", value);
  return fmt::format("{:.0f}e{}", value / std::pow(10, power), power);
}

}  // namespace

double LogAxis::at(double value) const {
  return start + (std::log10(value) - low) / (high - low) * (end - start);
}

LogAxis fitting_axis(const std::vector<double>& values, double start, double end) {
  if (values.empty()) return {-0.5, 0.5, start, end};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double low = std::log10(*least), high = std::log10(*most);
  const double room = std::max(0.05 * (high - low), (1 - (high - low)) / 2);
  const double margin = std::max(room, 0.08);
  return {low - margin, high + margin, start, end};
}

std::vector<Tick> ticks(const LogAxis& axis, double short_axis) {
  const double decades = axis.high - axis.low;
  constexpr double long_axis = 7;
  const int step = decades > long_axis ? 2 : 1;
  std::vector<Tick> result;
  for (int power = static_cast<int>(std::floor(axis.low)); power <= axis.high; ++power)
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10., power);
      if (const double place = std::log10(value); place < axis.low || place > axis.high) continue;
      const bool labelled =
          (digit == 1 && power % step == 0) || (decades < short_axis && (digit == 2 || digit == 5));
      result.push_back({value, labelled ? tick_label(value) : std::string()});
    }
  return result;
}

}  // namespace halfshade::detail
