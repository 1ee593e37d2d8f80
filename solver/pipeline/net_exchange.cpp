#include "solver/pipeline/net_exchange.h"

#include "meshing/core/error.h"
#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"
#include "solver/elements/material_arrays.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

/// A channel that is solved: of one band, what is above or what is below the surroundings.
struct Part {
  int band;
  double sign;
};

int bands_of(const Heat& heat) {
  return heat.bands.empty() ? 1 : static_cast<int>(heat.bands.size());
}

/// What a material sends out beyond what it would in equilibrium with the surroundings.
Rgb excess(const Material& material, const Rgb& space) {
  return material.exitance - (1 - material.rho) * space;
}

bool is_grey(const Rgb& value) { return value[0] == value[1] && value[0] == value[2]; }

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

std::vector<Part> find_signed_parts(const Scene& scene, const Heat& heat, const Rgb& space) {
  std::vector<Part> parts;
  for (int band = 0; band < bands_of(heat); ++band)
    for (const double sign : {1., -1.}) {
      const bool is_there = std::any_of(
          scene.materials.begin(), scene.materials.end(),
          [&](const Material& material) { return sign * excess(material, space)[band] > 0; });
      if (is_there) parts.push_back({band, sign});
    }
  if (parts.size() > most_bands)
    throw Error(ErrorCode::invalid_input, scene.source,
                fmt::format("in {} bands surfaces are hotter and colder than the surroundings of "
                            "{} K, which takes {} channels; there are {}",
                            bands_of(heat), *heat.surroundings, parts.size(), most_bands));
  return parts;
}

/// With a single part all channels are alike, so that one is solved.
Scene scene_of_parts(Scene scene, const std::vector<Part>& parts, const Rgb& space) {
  for (Material& material : scene.materials) {
    const Rgb rho = material.rho, more = excess(material, space);
    material.rho.setZero();
    material.exitance.setZero();
    for (std::size_t c = 0; c < most_bands && !parts.empty(); ++c) {
      if (c >= parts.size() && parts.size() > 1) break;
      const Part& part = parts[std::min(c, parts.size() - 1)];
      material.rho[static_cast<int>(c)] = rho[part.band];
      material.exitance[static_cast<int>(c)] = std::max(0., part.sign * more[part.band]);
    }
  }
  return scene;
}

/// Sums the parts of each band, and puts the surroundings back.
class Combination {
 public:
  Combination(const std::vector<Part>& parts, const Heat& heat, const Rgb& space)
      : parts_(parts), bands_(bands_of(heat)), space_(space) {}

  /// `uniform` rows of each element get what space sends.
  ChannelArray signed_sum(const ChannelArray& values) const {
    ChannelArray result = ChannelArray::Zero(values.rows(), 3);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      result.col(parts_[p].band) += parts_[p].sign * values.col(static_cast<Eigen::Index>(p));
    if (bands_ == 1)
      for (int c = 1; c < 3; ++c) result.col(c) = result.col(0);
    return result;
  }

  ChannelArray with_space(const ChannelArray& values) const {
    return signed_sum(values).rowwise() + space_.transpose();
  }

  void put_back(SolveResult& result) const {
    Solution& solution = result.solution;
    solution.irradiance = with_space(solution.irradiance);
    solution.direct_irradiance = signed_sum(solution.direct_irradiance);
    // From the irradiance: mirrors and equilibria stay exact.
    solution.radiosity = solution.exitance + solution.rho * solution.irradiance;
    for (ElementField* field : {&result.direct, &result.irradiance})
      if (field->count() > 0) field->coefficients = signed_sum(field->coefficients);
    for (int e = 0; e < result.irradiance.count(); ++e)
      result.irradiance.of(e).row(0) += space_.transpose();
  }

  /// Two parts may be off in opposite directions.
  double error_factor() const { return static_cast<int>(parts_.size()) > bands_ ? 2 : 1; }

  void sum_reports(const SolveResult& result, RadiosityReport& report) const {
    std::array<ChannelReport, 3> channels{};
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      ChannelReport& of_band = channels[static_cast<std::size_t>(parts_[p].band)];
      const ChannelReport& part = report.channel[p];
      const double escaped = of_band.escaped_power + parts_[p].sign * part.escaped_power;
      if (of_band.history.size() <= part.history.size()) of_band.history = part.history;
      of_band.iterations = std::max(of_band.iterations, part.iterations);
      of_band.residual = std::max(of_band.residual, part.residual);
      of_band.error = std::max(of_band.error, part.error);
      of_band.escaped_power = escaped;
    }
    const Solution& s = result.solution;
    const Eigen::Map<const Eigen::ArrayXd> area(result.elements.area.data(),
                                                result.elements.count());
    for (int c = 0; c < bands_; ++c) {
      ChannelReport& channel = channels[static_cast<std::size_t>(c)];
      channel.emitted_power = (area * s.exitance.col(c)).sum();
      channel.absorbed_power = (area * (1 - s.rho.col(c)) * s.irradiance.col(c)).sum();
      const double most = std::max(channel.emitted_power, channel.absorbed_power);
      channel.balance =
          most > 0
              ? std::abs(channel.emitted_power - channel.absorbed_power - channel.escaped_power) /
                    most
              : 0;
    }
    if (bands_ == 1) channels[1] = channels[2] = channels[0];
    report.channels = bands_ == 1 ? 1 : 3;
    report.channel = channels;
  }

 private:
  const std::vector<Part>& parts_;
  int bands_;
  Rgb space_;
};

void restore_materials(const Scene& scene, SolveResult& result) {
  result.scene.materials = scene.materials;
  const MaterialArrays arrays = material_arrays(result.scene, result.elements);
  result.solution.rho = arrays.rho;
  result.solution.exitance = arrays.exitance;
}

/// They speak of light that is lost or missing; with surroundings it comes from everywhere.
bool is_of_light(const Warning& warning) {
  return warning.kind == Warning::Kind::nothing_lit ||
         warning.kind == Warning::Kind::light_escapes || warning.kind == Warning::Kind::dark_groups;
}

void estimate_again(double factor, SolveResult& result) {
  result.solution.error_estimate *= factor;
  const double scale = balancing_scale(result.solution.irradiance.maxCoeff());
  const ChannelArray irradiance = scale * result.solution.irradiance;
  const Eigen::ArrayXd estimate = scale * result.solution.error_estimate;
  double of_solver = 0;
  for (const ChannelReport& channel : result.radiosity.channel)
    of_solver = std::max(of_solver, channel.error);
  result.relative_error = relative_error(result.elements, irradiance, estimate) + of_solver;
}

}  // namespace

SolveResult solve_net_exchange(const Scene& scene, const Heat& heat,
                               const std::function<SolveResult(const Scene&)>& solve) {
  if (!(heat.surroundings && *heat.surroundings > 0)) {
    SolveResult result = solve(scene);
    result.heat = heat;
    return result;
  }
  require_known_space(scene, heat);
  const Rgb space = blackbody_exitance(*heat.surroundings, heat.bands);
  const std::vector<Part> parts = find_signed_parts(scene, heat, space);
  SolveResult result = solve(scene_of_parts(scene, parts, space));
  result.heat = heat;
  result.reflected_light.reset();  // it knows the parts only
  restore_materials(scene, result);
  const Combination combination(parts, heat, space);
  combination.put_back(result);
  combination.sum_reports(result, result.radiosity);
  estimate_again(combination.error_factor(), result);
  std::erase_if(result.warnings, is_of_light);
  return result;
}

int channels_of(const SolveResult& result) {
  if (!result.heat.bands.empty()) return static_cast<int>(result.heat.bands.size());
  return result.radiosity.channels == 1 ? 1 : 3;
}

Eigen::ArrayXd temperatures(const Heat& heat, const std::vector<int>& material,
                            const ChannelArray& irradiance) {
  Eigen::ArrayXd result = Eigen::ArrayXd::Constant(irradiance.rows(), NAN);
  if (heat.materials.empty()) return result;
  for (std::size_t e = 0; e < material.size(); ++e) {
    const HeatMaterial& said = heat.materials[at(material[e])];
    const auto row = static_cast<Eigen::Index>(e);
    if (said.temperature) result[row] = *said.temperature;
    // What arrives is what leaves, and both are what a black body of that temperature sends.
    if (said.is_adiabatic) result[row] = blackbody_temperature(irradiance(row, 0));
  }
  return result;
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
  double arriving = 0;   ///< W, in the first channel
  double adiabatic = 0;  ///< m²
  double coldest = HUGE_VAL, hottest = -HUGE_VAL;

  void add(double area, double irradiance, bool is_adiabatic, double kelvin) {
    arriving += area * irradiance;
    if (is_adiabatic) adiabatic += area;
    coldest = std::min(coldest, std::isnan(kelvin) ? -HUGE_VAL : kelvin);
    hottest = std::max(hottest, kelvin);
  }

  double temperature(double area) const {
    if (area > 0 && adiabatic == area) return blackbody_temperature(arriving / area);
    return coldest == hottest ? coldest : NAN;
  }
};

}  // namespace

HeatSums sum_heat(const SolveResult& result) {
  HeatSums sums;
  sums.metres = require_metres_in(result.unit);
  const double square = sums.metres * sums.metres;
  for (const std::string& name : result.scene.groups) sums.groups.push_back({name});
  std::vector<GroupState> states(sums.groups.size());
  const Solution& solution = result.solution;
  const std::vector<int>& material = result.elements.material;
  const Eigen::ArrayXd kelvin = temperatures(result.heat, material, solution.irradiance);
  for (int e = 0; e < result.elements.count(); ++e) {
    GroupHeat& group = sums.groups[at(result.elements.group[at(e)])];
    const double area = square * result.elements.area[at(e)];
    group.area += area;
    group.net_power += area * (solution.radiosity.row(e) - solution.irradiance.row(e)).transpose();
    const bool is_adiabatic =
        !result.heat.materials.empty() && result.heat.materials[at(material[at(e)])].is_adiabatic;
    states[at(result.elements.group[at(e)])].add(area, solution.irradiance(e, 0), is_adiabatic,
                                                 kelvin[e]);
  }
  for (std::size_t g = 0; g < states.size(); ++g)
    sums.groups[g].temperature = states[g].temperature(sums.groups[g].area);
  for (int c = 0; c < 3; ++c)
    sums.to_space[c] = square * result.radiosity.channel[at(c)].escaped_power;
  return sums;
}

}  // namespace halfshade
