#include "io/picture/tone_map.h"

#include "io/files/srgb.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

constexpr double bright = 0.8;       // where the percentile goes, of linear white
constexpr double percentile = 0.95;  // of the weight
constexpr double least_of_mean = 0.25;
constexpr double knee = 0.6;     // display values below it are proportional to the radiosity
constexpr double whitening = 4;  // exposed values this far above 1 are most of the way to white

struct Weighted {
  double value, weight;
};

/// The smallest value that at least `percentile` of the weight does not exceed.
double weighted_percentile(std::vector<Weighted> samples) {
  std::sort(samples.begin(), samples.end(), [](const Weighted& a, const Weighted& b) {
    return a.value != b.value ? a.value < b.value : a.weight < b.weight;
  });
  double total = 0, sum = 0;
  for (const Weighted& sample : samples) total += sample.weight;
  for (const Weighted& sample : samples) {
    sum += sample.weight;
    if (sum >= percentile * total) return sample.value;
  }
  return samples.back().value;
}

/// 0 if no value is positive.
double exposure_of(std::vector<Weighted> samples) {
  double scale = 0;  // squares of values near the ends of the range of doubles stay in it
  for (const Weighted& sample : samples) scale = std::max(scale, sample.value);
  if (!(scale > 0)) return 0;
  double first = 0, second = 0;
  for (Weighted& sample : samples) {
    sample.value /= scale;
    first += sample.weight * sample.value;
    second += sample.weight * sample.value * sample.value;
  }
  const double typical =
      std::max(weighted_percentile(std::move(samples)), least_of_mean * second / first);
  const double exposure = bright / typical / scale;
  return std::isfinite(exposure) ? exposure : 0;
}

double shoulder(double x) {
  return x <= knee ? x : 1 - (1 - knee) * std::exp(-(x - knee) / (1 - knee));
}

}  // namespace

double choose_exposure(std::span<const Rgb> values, std::span<const double> weights,
                       std::span<const std::uint8_t> emits) {
  std::vector<Weighted> lamps, others;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (weights[i] > 0 && values[i].allFinite())
      (emits[i] != 0 ? lamps : others).push_back({std::max(0.0, values[i].maxCoeff()), weights[i]});
  double exposure = exposure_of(std::move(others));
  if (exposure == 0) exposure = exposure_of(std::move(lamps));
  return exposure > 0 ? exposure : 1;
}

Rgb tone_map(const Rgb& radiosity, double exposure) {
  constexpr double farthest = 1e6;  // white long before; keeps infinities out of the arithmetic
  Rgb x;
  for (int c = 0; c < 3; ++c) {
    const double exposed = radiosity[c] * exposure;
    x[c] = exposed > 0 ? std::min(exposed, farthest) : 0;  // NaN becomes 0
  }
  const double top = x.maxCoeff();
  if (top <= knee) return x;
  const double over = std::max(0.0, top - 1) / whitening;
  const double white = 1 - std::exp(-over * over);  // starts without a kink
  const Rgb coloured = x * (shoulder(top) / top);
  return (coloured + white * (1 - coloured)).min(1.0);
}

std::array<std::uint8_t, 3> encode_srgb(const Rgb& linear) {
  std::array<std::uint8_t, 3> bytes{};
  for (int c = 0; c < 3; ++c) {
    const double v = linear[c] > 0 ? std::min(linear[c], 1.0) : 0;
    const double encoded = detail::to_srgb(v);
    bytes[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255 * encoded));
  }
  return bytes;
}

}  // namespace halfshade
