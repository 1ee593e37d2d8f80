#include "solver/pipeline/mesh_scene.h"

#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// A point inside each element, for exact light there.
std::vector<SurfacePoint> centres(const ElementTable& elements) {
  std::vector<SurfacePoint> points;
  points.reserve(elements.corners.size());
  for (int e = 0; e < elements.count(); ++e) {
    const auto [a, b, c] = elements.triangle(e);
    points.push_back({(a + b + c) / 3, elements.normal[static_cast<std::size_t>(e)]});
  }
  return points;
}

void check(const MeshOptions& options) {
  const auto is_usable = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!is_usable(options.tolerance) || !is_usable(options.max_length) || options.secondary < 0)
    throw Error(ErrorCode::contract, "mesh_scene",
                fmt::format("tolerance ({}), max_length ({}) and secondary ({}) must be finite and "
                            "not negative",
                            options.tolerance, options.max_length, options.secondary));
}

/// Meshes and labels what was found.
void make_elements(const MeshOptions& options, const OpaqueScene& opaque, const Progress& progress,
                   Stages& stages, MeshResult& result) {
  const SoundScene& scene = result.scene;
  stages.run("mesh", [&] {
    DiscontinuityMeshOptions mesh_options;
    mesh_options.max_length = options.max_length;
    mesh_options.irradiance_tolerance = result.irradiance_tolerance;
    const DiscontinuityMesh mesh =
        mesh_discontinuities(scene, result.found, mesh_options, progress);
    result.mesh = mesh.report;
    result.elements = mesh.patches.elements();
    return result.elements.corners.size();
  });
  stages.run("regions", [&] {
    result.regions = label_elements(scene, opaque, result.elements, result.found.sources, progress);
    const DirectLightIndex index(scene);
    for (const DirectLight& light : index.irradiance(centres(result.elements), progress))
      result.region.push_back(light.region);
    return result.regions.size();
  });
}

}  // namespace

MeshResult mesh_scene(const Scene& scene, const MeshOptions& options, const Progress& progress) {
  check(options);
  validate(scene);
  require_emitter(scene);
  MeshResult result;
  result.cameras = scene.cameras;
  result.unit = scene.unit;
  Stages stages(result.stages);
  stages.run("repair", [&] {
    progress("repair", 0);
    result.scene = make_sound(scene);
    return result.scene.surfaces.size();
  });
  std::vector<LightSource> sources;
  stages.run("sources", [&] {
    sources = all_sources(scene, result.scene, options.secondary, progress);
    return sources.size();
  });
  if (options.tolerance > 0)
    stages.run("tolerance", [&] {
      result.irradiance_tolerance =
          options.tolerance * mean_direct_irradiance(result.scene, progress);
      return std::size_t{1};
    });
  const OpaqueScene opaque(result.scene);
  stages.run("discontinuities", [&] {
    DiscontinuityOptions events = options.events;
    events.irradiance_tolerance = result.irradiance_tolerance;
    events.max_length = options.max_length;
    result.found = find_discontinuities(result.scene, opaque, sources, events, progress);
    return result.found.curves.size();
  });
  if (options.with_elements) make_elements(options, opaque, progress, stages, result);
  stages.leave_out_if(!options.with_elements, "mesh", "only the curves were asked for");
  result.interrupted = progress.stopped();
  return result;
}

double mean_direct_irradiance(const SoundScene& scene, const Progress& progress) {
  constexpr int places = 2000;
  PlanarMeshOptions coarse;
  coarse.max_length = length_for_count(scene, places);
  const ElementTable elements = PatchMesh(scene, coarse, {progress.stop, {}}).elements();
  const DirectLightIndex index(scene);
  const std::vector<DirectLight> light = index.irradiance(centres(elements), progress);
  double power = 0, reached = 0;
  for (std::size_t e = 0; e < light.size(); ++e) {
    const double irradiance = light[e].irradiance.maxCoeff();
    if (!(irradiance > 0)) continue;
    power += elements.area[e] * irradiance;
    reached += elements.area[e];
  }
  return reached > 0 ? power / reached : 0;
}

std::vector<LightSource> secondary_sources(const Scene& scene, int count,
                                           const Progress& progress) {
  SolveOptions coarse;
  coarse.elements = 1000;
  coarse.discontinuities = false;
  const SolveResult solved = solve(scene, coarse, progress);
  const std::size_t surfaces = solved.scene.surfaces.size();
  std::vector<Rgb> reflected(surfaces, Rgb::Zero());  // power
  std::vector<double> areas(surfaces, 0);
  for (int e = 0; e < solved.elements.count(); ++e) {
    const auto k = static_cast<std::size_t>(e);
    const auto r = static_cast<std::size_t>(solved.elements.surface[k]);
    reflected[r] += solved.elements.area[k] * solved.solution.radiosity.row(e).transpose();
    areas[r] += solved.elements.area[k];
  }
  const auto power = [&](const LightSource& source) {
    return reflected[static_cast<std::size_t>(source.surface)].maxCoeff();
  };
  std::vector<LightSource> sources;
  for (std::size_t r = 0; r < surfaces; ++r) {
    const auto& material =
        solved.scene.materials[static_cast<std::size_t>(solved.scene.surfaces[r].material)];
    if ((material.exitance > 0).any() || !(reflected[r].maxCoeff() > 0)) continue;
    sources.push_back({static_cast<int>(r), reflected[r].maxCoeff() / areas[r]});
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [&](const auto& a, const auto& b) { return power(a) > power(b); });
  sources.resize(std::min(sources.size(), static_cast<std::size_t>(count)));
  return sources;
}

std::vector<LightSource> all_sources(const Scene& scene, const SoundScene& sound, int secondary,
                                     const Progress& progress) {
  std::vector<LightSource> sources = light_sources(sound);
  if (secondary == 0) return sources;
  const std::vector<LightSource> reflecting = secondary_sources(scene, secondary, progress);
  sources.insert(sources.end(), reflecting.begin(), reflecting.end());
  return sources;
}

bool is_convex(const SoundScene& scene) {
  const auto is_behind = [&](const Surface& viewer, const Surface& other) {
    const auto& ring = other.rings.front();
    return std::any_of(ring.begin(), ring.end(), [&](const Vec2& p) {
      return viewer.frame.height(other.frame.to_space(p)) < -scene.tolerance.length;
    });
  };
  for (const Surface& viewer : scene.surfaces)
    for (const Surface& other : scene.surfaces)
      if (is_behind(viewer, other)) return false;
  return true;
}

}  // namespace halfshade
