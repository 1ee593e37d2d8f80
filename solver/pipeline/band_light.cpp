#include "solver/pipeline/band_light.h"

#include "meshing/core/error.h"
#include "solver/pipeline/common_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

namespace halfshade {
namespace {

/// A channel that is solved: of one band, what is above or what is below the surroundings.
struct Part {
  int band;
  double sign;
};

using Parts = std::span<const Part>;

/// What materials send out beyond what they would in equilibrium with the surroundings.
Eigen::ArrayXXd excess(const BandMaterials& materials, const Eigen::ArrayXd& space) {
  return materials.exitance - (1 - materials.rho).rowwise() * space.transpose();
}

std::vector<Part> find_parts(const Eigen::ArrayXXd& more) {
  std::vector<Part> parts;
  for (int band = 0; band < more.cols(); ++band)
    for (const double sign : {1., -1.})
      if ((sign * more.col(band) > 0).any()) parts.push_back({band, sign});
  return parts;
}

/// With a single part all channels are alike, so that one is solved. With none any light will do,
/// for all that is taken from it is its elements.
Scene scene_of_parts(Scene scene, Parts parts, const BandMaterials& materials,
                     const Eigen::ArrayXXd& more) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    Material& material = scene.materials[m];
    const auto row = static_cast<Eigen::Index>(m);
    material.rho.setZero();
    material.exitance.setConstant(parts.empty() ? 1 : 0);
    for (std::size_t c = 0; c < most_channels && !parts.empty(); ++c) {
      if (c >= parts.size() && parts.size() > 1) break;
      const Part& part = parts[std::min(c, parts.size() - 1)];
      material.rho[static_cast<int>(c)] = materials.rho(row, part.band);
      material.exitance[static_cast<int>(c)] = std::max(0., part.sign * more(row, part.band));
    }
  }
  return scene;
}

/// Fails for what speaks of three channels only.
void require_joinable(const SolveResult& result, std::size_t parts) {
  const char* const option = result.goal                        ? "--goal"
                             : !result.regions.empty()          ? "--regions"
                             : !result.bounces.empty()          ? "--each-bounce"
                             : !result.radiosity.stages.empty() ? "--progressive"
                                                                : nullptr;
  if (option)
    throw Error(ErrorCode::usage, option,
                fmt::format("this is for three channels; the bands, hotter and colder than the "
                            "surroundings, take {}",
                            parts));
}

/// Sums of the columns of each band.
void add_signed(Parts parts, const ChannelArray& values, Eigen::ArrayXXd& sums) {
  for (std::size_t p = 0; p < parts.size(); ++p)
    sums.col(parts[p].band) += parts[p].sign * values.col(static_cast<Eigen::Index>(p));
}

void add_reports(Parts parts, const RadiosityReport& from, std::vector<ChannelReport>& bands) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    ChannelReport& band = bands[at(parts[p].band)];
    const ChannelReport& part = from.channel[p];
    if (band.history.size() <= part.history.size()) band.history = part.history;
    band.iterations = std::max(band.iterations, part.iterations);
    band.residual = std::max(band.residual, part.residual);
    band.error = std::max(band.error, part.error);
    band.escaped_power += parts[p].sign * part.escaped_power;
  }
}

/// Times of stages add up; warnings are told once.
void join_reports(const SolveResult& from, SolveResult& to) {
  for (const StageReport& stage : from.stages) {
    const auto same =
        std::find_if(to.stages.begin(), to.stages.end(), [&](const StageReport& other) {
          return other.name == stage.name &&
                 other.left_out_because.empty() == stage.left_out_because.empty();
        });
    if (same == to.stages.end()) {
      to.stages.push_back(stage);
    } else {
      same->seconds += stage.seconds;
      same->cpu_seconds += stage.cpu_seconds;
    }
  }
  for (const Warning& warning : from.warnings)
    if (std::none_of(to.warnings.begin(), to.warnings.end(),
                     [&](const Warning& other) { return other.sentence == warning.sentence; }))
      to.warnings.push_back(warning);
  to.radiosity.converged = to.radiosity.converged && from.radiosity.converged;
  to.interrupted = to.interrupted || from.interrupted;
  if (to.not_reached.empty()) to.not_reached = from.not_reached;
  to.relative_error = std::max(to.relative_error, from.relative_error);
}

std::vector<SolveResult> solve_packs(const Scene& scene, const std::vector<Part>& parts,
                                     const BandMaterials& materials, const Eigen::ArrayXXd& more,
                                     const SceneSolver& solve) {
  std::vector<SolveResult> solved;
  const std::size_t most = most_channels;
  for (std::size_t first = 0; first < std::max<std::size_t>(parts.size(), 1); first += most) {
    const Parts pack = Parts(parts).subspan(first, std::min(most, parts.size() - first));
    solved.push_back(solve(scene_of_parts(scene, pack, materials, more)));
    if (parts.size() > most) require_joinable(solved.back(), parts.size());
    if (!solved.back().interrupted) continue;
    // What is half done has other elements, or none.
    if (solved.size() > 1) solved.pop_back();
    solved.front().interrupted = true;
    break;
  }
  return solved;
}

}  // namespace

BandMaterials band_materials(const Scene& scene, const Heat& heat) {
  const auto count = static_cast<Eigen::Index>(scene.materials.size());
  BandMaterials result{Eigen::ArrayXXd(count, bands_of(heat)),
                       Eigen::ArrayXXd(count, bands_of(heat))};
  for (Eigen::Index m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    if (heat.bands.empty()) {
      result.rho(m, 0) = scene.materials[i].rho[0];
      result.exitance(m, 0) = scene.materials[i].exitance[0];
    } else {
      result.rho.row(m) = heat.materials[i].rho.transpose();
      result.exitance.row(m) = heat.materials[i].exitance.transpose();
    }
  }
  return result;
}

BandLight solve_bands(const Scene& scene, const BandMaterials& materials,
                      const Eigen::ArrayXd& space, const SceneSolver& solve) {
  const Eigen::ArrayXXd more = excess(materials, space);
  const std::vector<Part> parts = find_parts(more);
  std::vector<SolveResult> solved = solve_packs(scene, parts, materials, more, solve);
  if (solved.size() > 1) share_elements(solved);

  BandLight light;
  const Eigen::Index bands = space.size();
  const auto zeros = [&](Eigen::Index rows) {
    return Eigen::ArrayXXd(Eigen::ArrayXXd::Zero(rows, bands));
  };
  const SolveResult& first = solved.front();
  light.irradiance = light.direct_irradiance = zeros(first.solution.irradiance.rows());
  light.field = zeros(first.irradiance.coefficients.rows());
  light.direct_field = zeros(first.direct.coefficients.rows());
  light.reports.resize(static_cast<std::size_t>(bands));
  light.packs = static_cast<int>(solved.size());
  Eigen::ArrayXd error = Eigen::ArrayXd::Zero(first.solution.irradiance.rows());
  for (std::size_t k = 0; k < solved.size(); ++k) {
    const std::size_t begin = k * most_channels;
    const Parts pack =
        Parts(parts).subspan(begin, std::min<std::size_t>(most_channels, parts.size() - begin));
    add_signed(pack, solved[k].solution.irradiance, light.irradiance);
    add_signed(pack, solved[k].solution.direct_irradiance, light.direct_irradiance);
    if (first.irradiance.count() > 0) {
      add_signed(pack, solved[k].irradiance.coefficients, light.field);
      add_signed(pack, solved[k].direct.coefficients, light.direct_field);
    }
    add_reports(pack, solved[k].radiosity, light.reports);
    const double counts = bands > most_channels ? static_cast<double>(pack.size()) : 1.;
    if (!pack.empty()) error += counts * solved[k].solution.error_estimate;
    if (k > 0) join_reports(solved[k], solved[0]);
  }
  light.both_signs = static_cast<Eigen::Index>(parts.size()) > bands;
  light.result = std::move(solved.front());
  if (parts.empty()) light.result.not_reached.clear();
  light.result.solution.error_estimate = std::move(error);
  return light;
}

}  // namespace halfshade
