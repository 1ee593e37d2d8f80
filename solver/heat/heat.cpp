#include "solver/heat/heat.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace halfshade {
namespace {

/// hc/k in µm K, CODATA 2018.
constexpr double second_radiation_constant = 14387.768775039337;

/// Below this the series of exponentials takes long, and the one of powers few terms.
constexpr double series_limit = 1;
/// Terms below this share of their sum are lost to rounding.
constexpr double negligible = 1e-18;

/// 15/π⁴ ∫ from x to ∞ of t³/(eᵗ − 1): terms of e⁻ⁿˣ. x ≥ series_limit.
double share_beyond(double x) {
  double sum = 0;
  for (int n = 1;; ++n) {
    const double term =
        std::exp(-n * x) * (((x + 3. / n) * x + 6. / (1. * n * n)) * x + 6. / (1. * n * n * n)) / n;
    sum += term;
    if (!(term > negligible * sum)) break;
  }
  return 15 / std::pow(std::numbers::pi, 4) * sum;
}

/// The same from 0 to x: t³/(eᵗ − 1) = t² (1 − t/2 + Σ B_2k t^2k / (2k)!), term by term. x small.
double share_up_to(double x) {
  constexpr double coefficients[] = {1. / 12,           -1. / 720,
                                     1. / 30240,        -1. / 1209600,
                                     1. / 47900160,     -691. / 1307674368000,
                                     1. / 74724249600., -3617. / 10670622842880000.};
  double sum = 1. / 3 - x / 8, power = x * x;
  for (int k = 0; k < 8; ++k, power *= x * x) sum += coefficients[k] * power / (2 * k + 5);
  return 15 / std::pow(std::numbers::pi, 4) * sum * x * x * x;
}

}  // namespace

double blackbody_share_below(double wavelength, double temperature) {
  const double product = wavelength * temperature;
  if (!(product > 0)) return 0;
  if (std::isinf(product)) return 1;
  const double x = second_radiation_constant / product;
  return x < series_limit ? 1 - share_up_to(x) : share_beyond(x);
}

Rgb blackbody_exitance(double temperature, const std::vector<Band>& bands) {
  const double all = stefan_boltzmann * std::pow(temperature, 4);
  if (bands.empty() || (bands.size() == 1 && !bands[0].has_wavelengths)) return Rgb::Constant(all);
  Rgb result = Rgb::Zero();
  for (std::size_t c = 0; c < bands.size(); ++c)
    result[static_cast<int>(c)] =
        all * std::max(0., blackbody_share_below(bands[c].longest, temperature) -
                               blackbody_share_below(bands[c].shortest, temperature));
  if (bands.size() == 1) result = Rgb::Constant(result[0]);
  return result;
}

double blackbody_temperature(double exitance) {
  return std::sqrt(std::sqrt(exitance / stefan_boltzmann));
}

std::optional<double> metres_in(const std::string& unit) {
  static const std::pair<const char*, double> known[] = {{"m", 1},
                                                         {"metre", 1},
                                                         {"meter", 1},
                                                         {"metres", 1},
                                                         {"meters", 1},
                                                         {"dm", 0.1},
                                                         {"cm", 0.01},
                                                         {"centimetre", 0.01},
                                                         {"centimeter", 0.01},
                                                         {"mm", 0.001},
                                                         {"millimetre", 0.001},
                                                         {"millimeter", 0.001},
                                                         {"um", 1e-6},
                                                         {"µm", 1e-6},
                                                         {"km", 1000},
                                                         {"kilometre", 1000},
                                                         {"kilometer", 1000},
                                                         {"in", 0.0254},
                                                         {"inch", 0.0254},
                                                         {"ft", 0.3048},
                                                         {"foot", 0.3048},
                                                         {"feet", 0.3048},
                                                         {"yd", 0.9144}};
  const auto* found = std::find_if(std::begin(known), std::end(known),
                                   [&](const auto& one) { return unit == one.first; });
  if (found == std::end(known)) return std::nullopt;
  return found->second;
}

}  // namespace halfshade
