#include "io/picture/linear_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade::detail {
namespace {

/// The shortest of the round steps that makes no more than so many.
double round_step(double extent, int most) {
  const double rough = extent / std::max(most - 1, 1);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double digit : {1., 2., 5.})
    if (digit * power >= rough * (1 - 1e-9)) return digit * power;
  return 10 * power;
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int most, bool is_whole) {
  double step = round_step(high - low, most);
  if (is_whole) step = std::max(1., step);
  const double largest = std::max(std::abs(low), std::abs(high));
  const auto whole = [](double x) { return static_cast<int>(std::ceil(x)); };
  constexpr int most_before_point = 5, most_digits = 15;
  const int digits =
      std::clamp(std::max(whole(std::log10(largest / step)) + 1,
                          std::min(whole(std::log10(largest)) + 1, most_before_point)),
                 1, most_digits);
  std::vector<Tick> result;
  constexpr double rounding = 1e-9;  // of a step
  for (double k = std::ceil(low / step - rounding); k <= high / step + rounding; ++k) {
    const double value = k * step;
    result.push_back({value, k == 0 ? "0" : fmt::format("{:.{}g}", value, digits)});
  }
  return result;
}

}  // namespace halfshade::detail
