#include "solver/heat/heat.h"

#include "meshing/core/error.h"
#include "solver/heat/planck_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace halfshade {
namespace {

bool is_whole_spectrum(const std::vector<Band>& bands) {
  return bands.empty() || (bands.size() == 1 && !bands[0].has_wavelengths);
}

}  // namespace

double blackbody_share_below(double wavelength, double temperature) {
  return planck_part(0, wavelength, temperature).share;
}

Eigen::ArrayXd blackbody_exitance(double temperature, const std::vector<Band>& bands) {
  const double all = stefan_boltzmann * std::pow(temperature, 4);
  if (is_whole_spectrum(bands)) return Eigen::ArrayXd::Constant(1, all);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(bands.size()));
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const double part = all * planck_part(bands[k].shortest, bands[k].longest, temperature).share;
    result[static_cast<Eigen::Index>(k)] = part < weakest_part ? 0 : part;
  }
  return result;
}

Eigen::ArrayXd blackbody_slope(double temperature, const std::vector<Band>& bands) {
  const double each = stefan_boltzmann * std::pow(temperature, 3);
  if (is_whole_spectrum(bands)) return Eigen::ArrayXd::Constant(1, 4 * each);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(bands.size()));
  for (std::size_t k = 0; k < bands.size(); ++k)
    result[static_cast<Eigen::Index>(k)] =
        each * planck_part(bands[k].shortest, bands[k].longest, temperature).slope;
  return result;
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

bool is_balanced(const Heat& heat, const std::vector<Material>& materials, int material) {
  return !heat.materials.empty() && heat.materials[at(material)].is_adiabatic &&
         (bands_of(heat) > 1 || materials[at(material)].two_sided);
}

bool balances_faces(const Heat& heat, const std::vector<Material>& materials) {
  for (int m = 0; m < static_cast<int>(heat.materials.size()); ++m)
    if (is_balanced(heat, materials, m)) return true;
  return false;
}

void require_heat(const Scene& scene, const Heat& heat) {
  if (heat.surroundings && *heat.surroundings > 0) return;
  for (const Face& face : scene.faces)
    if ((scene.materials.at(at(face.material)).exitance > 0).any()) return;
  throw Error(ErrorCode::invalid_input, scene.source,
              fmt::format("no face sends out heat{}; give a material a 'temperature' above 0 K or "
                          "an 'exitance', or give --surroundings, the temperature of all that is "
                          "seen through openings",
                          heat.bands.empty() ? "" : " that the bands hold"));
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
