#include "solver/heat/emission.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr double coldest = 1e-60, hottest = 1e60;
/// Halving alone takes sixty.
constexpr int most_steps_for_one = 200;
/// Relative, of a temperature.
constexpr double hardly_moves = 4e-16;

}  // namespace

Emission emission_at(double temperature, const Eigen::ArrayXd& emissivity,
                     const std::vector<Band>& bands) {
  return {emissivity * blackbody_exitance(temperature, bands),
          emissivity * blackbody_slope(temperature, bands) * temperature};
}

double emission_temperature(double power, const Eigen::ArrayXd& emissivity,
                            const std::vector<Band>& bands, double start) {
  if (!(emission_at(hottest, emissivity, bands).power.sum() > power)) return NAN;
  if (!(power >= weakest_part)) return 0;
  // Bodies send out the more, the hotter they are. In logarithms, what Newton's method solves is
  // straight where they send a power of T, and steeper where they are too cold for their bands.
  double low = std::log(coldest), high = std::log(hottest);
  double at =
      std::clamp(start > 0 ? std::log(start) : std::log(blackbody_temperature(power)), low, high);
  for (int step = 0; step < most_steps_for_one && high - low > hardly_moves; ++step) {
    const Emission now = emission_at(std::exp(at), emissivity, bands);
    const double sent = now.power.sum();
    (sent < power ? low : high) = at;
    const double change = sent > 0 ? std::log(power / sent) * (sent / now.growth.sum()) : NAN;
    const double next = at + change;
    if (std::abs(change) <= hardly_moves) break;
    at = next > low && next < high ? next : (low + high) / 2;
  }
  const double kelvin = std::exp(at);
  return kelvin > coldest * 2 ? kelvin : NAN;
}

}  // namespace halfshade
