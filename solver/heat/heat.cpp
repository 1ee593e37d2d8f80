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

/// What the share of σT⁴ below λ grows by with ln(λT).
double share_slope(double wavelength_times_temperature) {
  const double x = second_radiation_constant / wavelength_times_temperature;
  if (!(x > 0) || std::isinf(x)) return 0;
  return 15 / std::pow(std::numbers::pi, 4) * std::pow(x, 4) / std::expm1(x);
}

bool is_whole_spectrum(const std::vector<Band>& bands) {
  return bands.empty() || (bands.size() == 1 && !bands[0].has_wavelengths);
}

}  // namespace

double blackbody_share_below(double wavelength, double temperature) {
  const double product = wavelength * temperature;
  if (!(product > 0)) return 0;
  if (std::isinf(product)) return 1;
  const double x = second_radiation_constant / product;
  return x < series_limit ? 1 - share_up_to(x) : share_beyond(x);
}

Eigen::ArrayXd blackbody_exitance(double temperature, const std::vector<Band>& bands) {
  const double all = stefan_boltzmann * std::pow(temperature, 4);
  if (is_whole_spectrum(bands)) return Eigen::ArrayXd::Constant(1, all);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(bands.size()));
  for (std::size_t k = 0; k < bands.size(); ++k)
    result[static_cast<Eigen::Index>(k)] =
        all * std::max(0., blackbody_share_below(bands[k].longest, temperature) -
                               blackbody_share_below(bands[k].shortest, temperature));
  return result;
}

Eigen::ArrayXd blackbody_slope(double temperature, const std::vector<Band>& bands) {
  const double all = stefan_boltzmann * std::pow(temperature, 4);
  Eigen::ArrayXd result = 4 * blackbody_exitance(temperature, bands);
  if (!is_whole_spectrum(bands))
    for (std::size_t k = 0; k < bands.size(); ++k)
      result[static_cast<Eigen::Index>(k)] += all * (share_slope(bands[k].longest * temperature) -
                                                     share_slope(bands[k].shortest * temperature));
  return result / temperature;
}

Rgb to_channels(const Eigen::ArrayXd& by_band, double all) {
  if (by_band.size() == 1) return Rgb::Constant(by_band[0]);
  if (by_band.size() > most_channels) return Rgb::Constant(all);
  Rgb result = Rgb::Zero();
  result.head(by_band.size()) = by_band;
  return result;
}

int bands_of(const Heat& heat) {
  return heat.bands.empty() ? 1 : static_cast<int>(heat.bands.size());
}

bool balances_bands(const Heat& heat) {
  return bands_of(heat) > 1 &&
         std::any_of(heat.materials.begin(), heat.materials.end(),
                     [](const HeatMaterial& said) { return said.is_adiabatic; });
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
