#include "solver/pipeline/sources.h"

#include "solver/pipeline/limits.h"
#include "solver/pipeline/lit_surfaces.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/solve_light.h"
#include "solver/pipeline/solve_mesh.h"

#include <algorithm>

namespace halfshade {
namespace {

/// About how many elements tell which surfaces reflect most.
constexpr int coarse_elements = 1000;
/// Beyond this share of all area that emits, direct light is no sharper than reflected.
constexpr double most = 0.5;
/// Shares of power this much above the tolerance, relatively, are still within it.
constexpr double rounding = 1e-9;

/// A mesh that knows nothing of shadows, and the light on it.
struct CoarseSolution {
  ElementTable elements;
  Solution light;
};

CoarseSolution solve_coarsely(const PreparedScene& prepared, const Progress& progress) {
  SolveOptions wanted;
  wanted.method = SolveMethod::matrix;
  wanted.elements = coarse_elements;
  const SolveOptions options = with_limits(wanted, prepared.scene().surfaces.size());
  std::vector<StageReport> ignored;
  Stages stages(ignored);
  CoarseSolution solution;
  solution.elements = make_solve_mesh(prepared.scene(), options, progress).elements;
  Plan plan;
  plan.no_exact_direct_light = most_surfaces_emit(prepared.scene());
  plan.no_factors = factors_needless(prepared.scene(), plan.no_exact_direct_light.empty(), options);
  plan.no_channels = channels_needless(prepared.scene(), options);
  solution.light =
      solve_light(prepared, solution.elements, plan, options, progress, stages).solution;
  return solution;
}

}  // namespace

std::vector<LightSource> secondary_sources(const PreparedScene& prepared, int count,
                                           const Progress& progress) {
  const SoundScene& scene = prepared.scene();
  const CoarseSolution solved = solve_coarsely(prepared, progress);
  const std::size_t surfaces = scene.surfaces.size();
  std::vector<Rgb> reflected(surfaces, Rgb::Zero());  // power
  std::vector<double> areas(surfaces, 0);
  for (int e = 0; e < solved.elements.count(); ++e) {
    const std::size_t r = at(solved.elements.surface[at(e)]);
    reflected[r] += solved.elements.area[at(e)] * solved.light.radiosity.row(e).transpose();
    areas[r] += solved.elements.area[at(e)];
  }
  const auto power = [&](const LightSource& source) {
    return reflected[at(source.surface)].maxCoeff();
  };
  std::vector<LightSource> sources;
  for (std::size_t r = 0; r < surfaces; ++r) {
    const Material& material = scene.materials[at(scene.surfaces[r].material)];
    if ((material.exitance > 0).any() || !(reflected[r].maxCoeff() > 0)) continue;
    sources.push_back({static_cast<int>(r), reflected[r].maxCoeff() / areas[r]});
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [&](const auto& a, const auto& b) { return power(a) > power(b); });
  sources.resize(std::min(sources.size(), static_cast<std::size_t>(count)));
  return sources;
}

std::vector<LightSource> all_sources(const PreparedScene& prepared, int secondary,
                                     const Progress& progress) {
  std::vector<LightSource> sources = light_sources(prepared.scene());
  if (secondary == 0) return sources;
  const std::vector<LightSource> reflecting = secondary_sources(prepared, secondary, progress);
  sources.insert(sources.end(), reflecting.begin(), reflecting.end());
  return sources;
}

std::vector<LightSource> strong_enough(std::vector<LightSource> sources, const SoundScene& scene,
                                       double tolerance) {
  const auto power = [&](const LightSource& source) {
    return source.exitance * area(scene.surfaces[at(source.surface)]);
  };
  double all = 0;
  for (const LightSource& source : sources) all += power(source);
  std::erase_if(sources, [&](const LightSource& source) {
    return power(source) <= (1 + rounding) * tolerance * all;
  });
  return sources;
}

std::string most_surfaces_emit(const SoundScene& scene) {
  double all = 0, emitting = 0;
  const std::vector<int> lit = lit_surfaces(scene, hardly_lit);
  std::size_t emitters = 0;
  for (const int s : lit) {
    const Surface& surface = scene.surfaces[at(s)];
    const Material& material = scene.materials[at(surface.material)];
    all += area(surface);
    if (!(material.exitance > 0).any()) continue;
    emitting += area(surface);
    ++emitters;
  }
  // By number, too: a sun has nearly all the area and casts the sharpest shadows.
  return emitting > most * all &&
                 static_cast<double>(emitters) > most * static_cast<double>(lit.size())
             ? "most surfaces emit, so that direct light is no sharper than reflected"
             : "";
}

}  // namespace halfshade
