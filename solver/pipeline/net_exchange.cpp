#include "solver/pipeline/net_exchange.h"

#include "meshing/core/error.h"
#include "solver/pipeline/adiabatic_faces.h"
#include "solver/pipeline/fixed_temperatures.h"
#include "solver/pipeline/heat_sums.h"
#include "solver/pipeline/result_error.h"
#include "solver/pipeline/seen_backs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

bool is_grey(const Rgb& value) { return value[0] == value[1] && value[0] == value[2]; }

bool has_surroundings(const Heat& heat) { return heat.surroundings && *heat.surroundings > 0; }

/// Fails unless it is known how much the surroundings send in each channel.
void require_known_space(const Scene& scene, const Heat& heat) {
  const auto refuse = [&](const std::string& sentence) {
    throw Error(ErrorCode::invalid_input, scene.source,
                fmt::format("which part of what surroundings of {} K send a channel has is not "
                            "known, for {}",
                            *heat.surroundings, sentence));
  };
  for (const Band& band : heat.bands)
    if (heat.bands.size() > 1 && !band.has_wavelengths)
      refuse(fmt::format("the band '{}' has no 'wavelengths_um'", band.name));
  for (const Material& material : scene.materials)
    if (heat.bands.empty() && !(is_grey(material.rho) && is_grey(material.exitance)))
      refuse(
          fmt::format("material '{}' differs between red, green and blue; give the materials "
                      "'bands' with 'wavelengths_um'",
                      material.name));
}

/// Light of bands as channels of a result: as they are, or their sums.
class Channels {
 public:
  Channels(const BandLight& light, const BandMaterials& materials, const Eigen::ArrayXd& space)
      : light_(light), materials_(materials), space_(space) {}

  void fill(SolveResult& result) const {
    Solution& solution = result.solution;
    const auto rows = static_cast<Eigen::Index>(result.elements.corners.size());
    const Eigen::ArrayXXd irradiance = light_.irradiance.rowwise() + space_.transpose();
    const Eigen::ArrayXXd rho = materials_.rho(result.elements.material, Eigen::all);
    const Eigen::ArrayXXd exitance = materials_.exitance(result.elements.material, Eigen::all);
    solution.irradiance = channels(irradiance);
    solution.direct_irradiance = channels(light_.direct_irradiance);
    solution.exitance = channels(exitance);
    solution.rho.resize(rows, 3);
    for (Eigen::Index e = 0; e < rows; ++e)
      solution.rho.row(e) =
          to_channels(rho.row(e), reflected_share(rho.row(e), irradiance.row(e))).transpose();
    // From the irradiance: mirrors and equilibria stay exact.
    solution.radiosity = solution.exitance + solution.rho * solution.irradiance;
    if (is_sum()) {
      solution.band_irradiance = irradiance;
      solution.band_radiosity = exitance + rho * irradiance;
      solution.radiosity = channels(solution.band_radiosity);
    }
    if (result.irradiance.count() > 0) {
      result.irradiance.coefficients = channels(light_.field);
      result.direct.coefficients = channels(light_.direct_field);
    }
    for (int e = 0; e < result.irradiance.count(); ++e)
      result.irradiance.of(e).row(0) += to_channels(space_, space_.sum()).transpose();
    fill_reports(result, irradiance, rho, exitance);
  }

 private:
  bool is_sum() const { return space_.size() > most_channels; }

  ChannelArray channels(const Eigen::ArrayXXd& by_band) const {
    ChannelArray result(by_band.rows(), 3);
    for (Eigen::Index row = 0; row < by_band.rows(); ++row)
      result.row(row) = to_channels(by_band.row(row), by_band.row(row).sum()).transpose();
    return result;
  }

  static double reflected_share(const Eigen::ArrayXd& rho, const Eigen::ArrayXd& irradiance) {
    const double all = irradiance.sum();
    return all > 0 ? std::clamp((rho * irradiance).sum() / all, 0., 1.) : rho.mean();
  }

  void fill_reports(SolveResult& result, const Eigen::ArrayXXd& irradiance,
                    const Eigen::ArrayXXd& rho, const Eigen::ArrayXXd& exitance) const {
    const Eigen::Map<const Eigen::ArrayXd> area(result.elements.area.data(),
                                                result.elements.count());
    std::vector<ChannelReport> bands = light_.reports;
    result.found_heat.escaped_power.resize(space_.size());
    for (Eigen::Index k = 0; k < space_.size(); ++k) {
      ChannelReport& band = bands[static_cast<std::size_t>(k)];
      band.emitted_power = (area * exitance.col(k)).sum();
      band.absorbed_power = (area * (1 - rho.col(k)) * irradiance.col(k)).sum();
      result.found_heat.escaped_power[k] = band.escaped_power;
    }
    if (is_sum()) bands.assign(1, joined(bands));
    for (ChannelReport& band : bands) {
      const double most = std::max(band.emitted_power, band.absorbed_power);
      const double missing = band.emitted_power - band.absorbed_power - band.escaped_power;
      band.balance = most > 0 ? std::abs(missing) / most : 0;
    }
    result.radiosity.channels = bands.size() == 1 ? 1 : 3;
    if (bands.size() == 1) bands.resize(3, bands[0]);
    bands.resize(3);
    std::copy(bands.begin(), bands.end(), result.radiosity.channel.begin());
  }

  static ChannelReport joined(const std::vector<ChannelReport>& bands) {
    ChannelReport sum;
    for (const ChannelReport& band : bands) {
      if (sum.history.size() <= band.history.size()) sum.history = band.history;
      sum.iterations = std::max(sum.iterations, band.iterations);
      sum.residual = std::max(sum.residual, band.residual);
      sum.error = std::max(sum.error, band.error);
      sum.emitted_power += band.emitted_power;
      sum.absorbed_power += band.absorbed_power;
      sum.escaped_power += band.escaped_power;
    }
    return sum;
  }

  const BandLight& light_;
  const BandMaterials& materials_;
  const Eigen::ArrayXd& space_;
};

/// They speak of light that is lost or missing; with surroundings it comes from everywhere.
bool is_of_light(const Warning& warning) {
  return warning.kind == Warning::Kind::nothing_lit ||
         warning.kind == Warning::Kind::light_escapes || warning.kind == Warning::Kind::dark_groups;
}

/// As the scene has them, instead of copies.
void restore_materials(const Scene& scene, const std::vector<int>& original, SolveResult& result) {
  result.scene.materials = scene.materials;
  if (original.empty()) return;
  for (int& material : result.elements.material) material = original[at(material)];
  for (Surface& surface : result.scene.surfaces) surface.material = original[at(surface.material)];
}

SolveResult assembled(BandLight light, const BandMaterials& materials, const Eigen::ArrayXd& space,
                      const Heat& heat) {
  SolveResult result = std::move(light.result);
  result.heat = heat;
  result.reflected_light.reset();  // it knows the parts only
  result.patches.reset();
  Channels(light, materials, space).fill(result);
  if (light.both_signs) result.solution.error_estimate *= 2;
  result.relative_error = error_of_elements_and_solver(result);
  if (has_surroundings(heat)) std::erase_if(result.warnings, is_of_light);
  return result;
}

bool has_adiabatic(const Heat& heat) {
  return std::any_of(heat.materials.begin(), heat.materials.end(),
                     [](const HeatMaterial& said) { return said.is_adiabatic; });
}

/// Fails where an adiabatic temperature in one band does not follow from the irradiance.
void require_found(const Scene& scene, const Heat& heat, const SolveResult& result) {
  const bool is_unseen = bands_of(heat) == 1 && unseen_bands(heat)[0] > 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const int material = result.elements.material[at(e)];
    if (!heat.materials[at(material)].is_adiabatic || is_balanced(heat, scene.materials, material))
      continue;
    const double irradiance = result.solution.irradiance(e, 0);
    if ((is_unseen && irradiance < weakest_part) ||
        std::isnan(temperature_in_balance(irradiance, heat)))
      refuse_bands(scene, result.elements.face[at(e)]);
  }
}

/// With all materials as the scene has them.
SolveResult solve_without_balance(const Scene& scene, const Heat& heat, const Eigen::ArrayXd& space,
                                  const SceneSolver& solve) {
  const BandMaterials materials = band_materials(scene, heat);
  SolveResult result;
  if (has_surroundings(heat) || bands_of(heat) > most_channels) {
    result = assembled(solve_bands(scene, materials, space, solve), materials, space, heat);
    restore_materials(scene, {}, result);
  } else {
    result = solve(scene);
    result.heat = heat;
  }
  if (result.interrupted || !has_adiabatic(heat)) return result;
  require_fixed_temperatures(scene, heat, materials, {}, result.scene);
  require_found(scene, heat, result);
  return result;
}

/// Without a word on how it went.
SolveResult solve_heat(const Scene& scene, const Heat& heat, const SceneSolver& solve) {
  Eigen::ArrayXd space = Eigen::ArrayXd::Zero(bands_of(heat));
  if (has_surroundings(heat)) {
    require_known_space(scene, heat);
    space = blackbody_exitance(*heat.surroundings, heat.bands);
  }
  if (!balances_faces(heat, scene.materials))
    return solve_without_balance(scene, heat, space, solve);
  AdiabaticFaces faces = adiabatic_faces(scene, heat);
  std::vector<double> kelvin = find_temperatures(faces, heat, space, solve);
  SolveResult result = assembled(solve_bands(faces.scene, faces.materials, space, solve),
                                 faces.materials, space, heat);
  result.found_heat.face_temperature = std::move(kelvin);
  restore_materials(scene, faces.original, result);
  if (!result.interrupted) require_found(scene, heat, result);
  return result;
}

}  // namespace

SolveResult solve_net_exchange(const Scene& scene, const Heat& heat, const SceneSolver& solve) {
  SolveResult result = solve_heat(scene, heat, solve);
  if (heat.is_given) add(back_warnings(result.scene, heat), result.warnings);
  return result;
}

}  // namespace halfshade
