#include "solver/pipeline/solve.h"

#include "meshing/core/error.h"
#include "meshing/rays/visibility.h"
#include "meshing/repair/repair.h"
#include "solver/adapt/recovery_estimate.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/mesh_scene.h"
#include "solver/pipeline/solve_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

void material_arrays(const SoundScene& scene, const ElementTable& elements, ChannelArray& rho,
                     ChannelArray& exitance) {
  rho.resize(elements.count(), 3);
  exitance.resize(elements.count(), 3);
  for (int e = 0; e < elements.count(); ++e) {
    const auto& material =
        scene.materials[static_cast<std::size_t>(elements.material[static_cast<std::size_t>(e)])];
    rho.row(e) = material.rho.transpose();
    exitance.row(e) = material.exitance.transpose();
  }
}

/// Why direct light, and the lines where it breaks, deserve no effort; empty if they do.
std::string most_surfaces_emit(const SoundScene& scene) {
  constexpr double most = 0.5;
  double all = 0, emitting = 0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    all += area(surface);
    if ((material.exitance > 0).any()) emitting += area(surface);
  }
  return emitting > most * all
             ? "most surfaces emit, so that direct light is no sharper than reflected"
             : "";
}

/// Why direct light needs no stage of its own; empty if it does.
std::string direct_light_needless(const SoundScene& scene, DirectLightBy choice) {
  if (choice == DirectLightBy::exact) return {};
  if (choice == DirectLightBy::matrix) return "the matrix was asked for";
  return most_surfaces_emit(scene);
}

/// Why no discontinuities need be looked for; empty if they do.
std::string discontinuities_needless(const SoundScene& scene, const SolveOptions& options) {
  const DiscontinuityOptions& events = options.events;
  if (!options.discontinuities || !(events.contact || events.face || events.ev || events.eee))
    return "they were not asked for";
  if (is_convex(scene)) return "no surface can come between two others";
  return most_surfaces_emit(scene);
}

/// Without the sources whose share of all power sent is no more than the tolerance: were their
/// light wrong everywhere, it would still be within it.
std::vector<LightSource> strong_enough(std::vector<LightSource> sources, const SoundScene& scene,
                                       double tolerance) {
  constexpr double rounding = 1e-9;
  const auto power = [&](const LightSource& source) {
    return source.exitance * area(scene.surfaces[static_cast<std::size_t>(source.surface)]);
  };
  double all = 0;
  for (const LightSource& source : sources) all += power(source);
  std::erase_if(sources, [&](const LightSource& source) {
    return power(source) <= (1 + rounding) * tolerance * all;
  });
  return sources;
}

/// Meshes the scene, along its discontinuities if it has any.
void make_elements(const Scene& scene, const SolveOptions& options, const Progress& progress,
                   Stages& stages, SolveResult& result) {
  Discontinuities found;
  double mean_irradiance = 0;
  std::vector<LightSource> sources;
  std::string needless = discontinuities_needless(result.scene, options);
  if (needless.empty()) {
    stages.run("sources", [&] {
      sources = strong_enough(all_sources(scene, result.scene, options.secondary, progress),
                              result.scene, options.tolerance);
      return sources.size();
    });
    if (sources.empty()) needless = "no source gives more than the tolerance of all light";
  }
  stages.leave_out_if(!needless.empty(), "discontinuities", needless);
  if (needless.empty())
    stages.run("discontinuities", [&] {
      mean_irradiance = mean_direct_irradiance(result.scene, progress);
      DiscontinuityOptions events = options.events;
      events.irradiance_tolerance = options.tolerance * mean_irradiance;
      events.max_length = longest_edge(result.scene, options);
      found =
          find_discontinuities(result.scene, OpaqueScene(result.scene), sources, events, progress);
      return found.curves.size();
    });
  result.discontinuities = found.report;
  result.curves = found.curves.size();
  stages.run("mesh", [&] {
    SolveMesh mesh = found.curves.empty()
                         ? make_solve_mesh(result.scene, options, progress)
                         : make_solve_mesh(result.scene, found, options, mean_irradiance, progress);
    result.mesh = mesh.report;
    result.discontinuity_tolerance = mesh.tolerance;
    result.elements = std::move(mesh.elements);
    return result.elements.corners.size();
  });
}

/// In a closed enclosure everything an emitter sends arrives somewhere. Averaging over elements
/// loses or gains a little where shadows cut them; one factor for each emitter puts that right.
void conserve_power(ElementDirectLight& light, const SoundScene& scene,
                    const ElementTable& elements, const Enclosures& enclosures) {
  const Eigen::Map<const Eigen::ArrayXd> areas(elements.area.data(), elements.count());
  for (std::size_t k = 0; k < light.emitters.size(); ++k) {
    const auto first =
        std::find(elements.surface.begin(), elements.surface.end(), light.emitters[k]);
    if (first == elements.surface.end() ||
        !enclosures.is_closed(static_cast<int>(first - elements.surface.begin())))
      continue;
    auto factors = light.factor.col(static_cast<Eigen::Index>(k));
    const double arriving = (areas * factors).sum();
    if (arriving > 0)
      factors *= area(scene.surfaces[static_cast<std::size_t>(light.emitters[k])]) / arriving;
  }
}

void check(const SolveOptions& options) {
  if (options.elements < 1 || options.max_elements < 1 || !(options.max_length >= 0))
    throw Error(
        ErrorCode::contract, "solve",
        fmt::format("elements ({}) and max_elements ({}) must be at least 1 and max_length ({}) "
                    "not negative",
                    options.elements, options.max_elements, options.max_length));
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)) || options.secondary < 0)
    throw Error(ErrorCode::contract, "solve",
                fmt::format("tolerance ({}) and secondary ({}) must be finite and not negative",
                            options.tolerance, options.secondary));
}

}  // namespace

SolveResult solve(const Scene& scene, const SolveOptions& options, const Progress& progress) {
  check(options);
  validate(scene);
  require_emitter(scene);
  SolveResult result;
  result.cameras = scene.cameras;
  result.unit = scene.unit;
  Stages stages(result.stages);
  stages.run("repair", [&] {
    progress("repair", 0);
    result.scene = make_sound(scene);
    return result.scene.surfaces.size();
  });
  make_elements(scene, options, progress, stages, result);
  ElementDirectLight light;
  const std::string needless = direct_light_needless(result.scene, options.direct_light);
  stages.leave_out_if(!needless.empty(), "exact direct light", needless);
  if (needless.empty())
    stages.run("exact direct light", [&] {
      const DirectLightIndex index(result.scene);
      light = element_direct_light(result.scene, result.elements, index, options.direct_points,
                                   progress);
      return light.emitters.size();
    });
  Exchange exchange;
  stages.run("form factors", [&] {
    const VisibilityIndex visibility(occluders(result.scene));
    exchange =
        compute_exchange(result.scene, result.elements, visibility, options.exchange, progress);
    return exchange.report.factors;
  });
  result.exchange = exchange.report;
  stages.leave_out_if(exchange.report.rays == 0, "visibility rays",
                      "no surface can come between two others");
  stages.leave_out_if(!exchange.report.closure_enforced && !exchange.report.closed, "closure",
                      "light can leave the scene");
  ChannelArray rho, exitance, direct_irradiance;
  if (needless.empty()) {
    if (exchange.report.closure_enforced)
      conserve_power(light, result.scene, result.elements, exchange.enclosures);
    direct_irradiance = irradiance_of(light, result.scene);
  }
  material_arrays(result.scene, result.elements, rho, exitance);
  stages.run("radiosity", [&] {
    result.solution = solve_radiosity(exchange, rho, exitance, direct_irradiance, options.radiosity,
                                      result.radiosity, progress);
    result.solution.region = std::move(light.region);
    return static_cast<std::size_t>(result.radiosity.unknowns);
  });
  stages.leave_out_if(result.radiosity.unknowns == 0, "interreflection", "no surface reflects");
  stages.leave_out_if(result.radiosity.channels == 1, "second and third channel",
                      "every material is grey");
  stages.run("error estimate", [&] {
    const ChannelArray& irradiance = result.solution.irradiance;
    result.solution.error_estimate = recovery_estimate(result.elements, irradiance);
    result.relative_error =
        relative_error(result.elements, irradiance, result.solution.error_estimate);
    return result.elements.corners.size();
  });
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace halfshade
