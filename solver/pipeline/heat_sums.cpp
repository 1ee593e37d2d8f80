#include "solver/pipeline/heat_sums.h"

#include "meshing/core/error.h"
#include "solver/heat/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {

int channels_of(const SolveResult& result) {
  if (!result.heat.bands.empty()) return static_cast<int>(result.heat.bands.size());
  return result.radiosity.channels == 1 ? 1 : 3;
}

double temperature_in_balance(double irradiance, const Heat& heat) {
  if (heat.bands.empty() || !heat.bands[0].has_wavelengths)
    return blackbody_temperature(std::max(0., irradiance));
  return emission_temperature(irradiance, Eigen::ArrayXd::Ones(1), heat.bands);
}

Eigen::ArrayXd temperatures(const SolveResult& result, const ElementTable& elements,
                            const ChannelArray& irradiance) {
  Eigen::ArrayXd kelvin = Eigen::ArrayXd::Constant(irradiance.rows(), NAN);
  const std::vector<double>& found = result.found_heat.face_temperature;
  if (result.heat.materials.empty()) return kelvin;
  for (int e = 0; e < elements.count(); ++e) {
    const HeatMaterial& said = result.heat.materials[at(elements.material[at(e)])];
    if (said.temperature) kelvin[e] = *said.temperature;
    if (!said.is_adiabatic) continue;
    // In one band what arrives is what leaves, and both are what a black body of that temperature
    // sends.
    if (!is_balanced(result.heat, result.scene.materials, elements.material[at(e)]))
      kelvin[e] = temperature_in_balance(irradiance(e, 0), result.heat);
    else if (!found.empty())
      kelvin[e] = found[at(elements.face[at(e)])];
  }
  return kelvin;
}

double require_metres_in(const std::string& unit) {
  const std::optional<double> metres = metres_in(unit);
  if (!metres)
    throw Error(ErrorCode::invalid_input, {},
                fmt::format("the scene's unit of length is '{}', of which it is not known how many "
                            "metres it has; powers in W take a unit such as m, mm or inch",
                            unit));
  return *metres;
}

namespace {

/// What the elements of a group have in common.
struct GroupState {
  double sent = 0;       ///< W, that black bodies of its temperatures send
  double adiabatic = 0;  ///< m²
  double coldest = HUGE_VAL, hottest = -HUGE_VAL;

  void add(double area, double black, bool is_adiabatic, double kelvin) {
    sent += area * black;
    if (is_adiabatic) adiabatic += area;
    coldest = std::min(coldest, std::isnan(kelvin) ? -HUGE_VAL : kelvin);
    hottest = std::max(hottest, kelvin);
  }

  double temperature(double area) const {
    if (coldest == hottest) return coldest;
    return area > 0 && adiabatic == area ? blackbody_temperature(sent / area) : NAN;
  }
};

/// What an element gives net in each channel or band, W/m².
Eigen::ArrayXd net_flux(const SolveResult& result, int element) {
  const Solution& solution = result.solution;
  if (solution.band_radiosity.rows() > 0)
    return (solution.band_radiosity.row(element) - solution.band_irradiance.row(element))
        .transpose();
  const Eigen::Index channels = channels_of(result);
  return (solution.radiosity.row(element) - solution.irradiance.row(element))
      .head(channels)
      .transpose();
}

Eigen::ArrayXd escaped_power(const SolveResult& result) {
  if (result.found_heat.escaped_power.size() > 0) return result.found_heat.escaped_power;
  Eigen::ArrayXd power(channels_of(result));
  for (Eigen::Index c = 0; c < power.size(); ++c)
    power[c] = result.radiosity.channel[static_cast<std::size_t>(c)].escaped_power;
  return power;
}

}  // namespace

HeatSums sum_heat(const SolveResult& result) {
  HeatSums sums;
  sums.metres = require_metres_in(result.unit);
  const double square = sums.metres * sums.metres;
  for (const std::string& name : result.scene.groups)
    sums.groups.push_back({name, 0, Eigen::ArrayXd::Zero(channels_of(result))});
  std::vector<GroupState> states(sums.groups.size());
  const Solution& solution = result.solution;
  const ElementTable& elements = result.elements;
  const Eigen::ArrayXd kelvin = temperatures(result, elements, solution.irradiance);
  for (int e = 0; e < elements.count(); ++e) {
    GroupHeat& group = sums.groups[at(elements.group[at(e)])];
    const double area = square * elements.area[at(e)];
    group.area += area;
    group.net_power += area * net_flux(result, e);
    const bool is_adiabatic = !result.heat.materials.empty() &&
                              result.heat.materials[at(elements.material[at(e)])].is_adiabatic;
    const double black = stefan_boltzmann * std::pow(kelvin[e], 4);
    states[at(elements.group[at(e)])].add(area, black, is_adiabatic, kelvin[e]);
  }
  for (std::size_t g = 0; g < states.size(); ++g)
    sums.groups[g].temperature = states[g].temperature(sums.groups[g].area);
  sums.to_space = square * escaped_power(result);
  return sums;
}

}  // namespace halfshade
