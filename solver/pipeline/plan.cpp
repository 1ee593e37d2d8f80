#include "solver/pipeline/plan.h"

#include "solver/direct/direct_light.h"
#include "solver/pipeline/blockers.h"
#include "solver/pipeline/direct_rays.h"
#include "solver/pipeline/lit_places.h"
#include "solver/pipeline/lit_surfaces.h"
#include "solver/pipeline/sources.h"
#include "solver/pipeline/spread_places.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// About how many places tell the mean irradiance.
constexpr int places = 2000;
/// Where there are so many lines few places must do, for each sees much.
constexpr std::size_t many_lines = 4000;
constexpr int few_places = 100;
/// The same where a place's light takes more than so much, see DirectLight::crowd_work.
constexpr std::size_t much_work = 500;

/// In units of DiscontinuityOptions::most_work: less than a minute on two cores.
constexpr double most_work = 5e7;

bool has_many_lines(const SoundScene& scene) {
  std::size_t lines = scene.surfaces.size();
  for (const Surface& surface : scene.surfaces) lines += surface.contacts.size();
  return lines > many_lines;
}

std::vector<int> lit_and_emitting(const PreparedScene& prepared, const std::vector<int>& lit) {
  const std::span<const int> emitters = prepared.direct_light().emitters();
  std::vector<int> all = lit;
  all.insert(all.end(), emitters.begin(), emitters.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

Plan make_plan(const PreparedScene& prepared, const SolveOptions& options, const Progress& progress,
               Stages& stages) {
  Plan plan;
  const SoundScene& scene = prepared.scene();
  plan.lit = lit_surfaces(scene, unnoticed_of_tolerance * options.tolerance);
  plan.no_exact_direct_light = direct_light_needless(
      scene, options.force.exact_direct_light ? DirectLightBy::exact : options.direct_light);
  plan.no_factors = factors_needless(scene, plan.no_exact_direct_light.empty(), options);
  plan.no_channels = channels_needless(scene, options);
  if (plan.no_exact_direct_light.empty()) plan.rays = direct_rays(prepared, options, progress);
  const std::vector<int> exchanging = lit_and_emitting(prepared, plan.lit);
  plan.no_discontinuities = discontinuities_needless(scene, exchanging, options);
  if (!plan.no_discontinuities.empty()) return plan;
  stages.run("sources", [&] {
    plan.sources = all_sources(prepared, options.secondary, progress);
    plan.weak_sources = plan.sources.size();
    if (!options.force.discontinuities)
      plan.sources = strong_enough(std::move(plan.sources), scene, options.tolerance);
    plan.weak_sources -= plan.sources.size();
    if (!plan.sources.empty()) plan.mean_irradiance = mean_direct_irradiance(prepared, progress);
    return plan.sources.size();
  });
  if (plan.sources.empty())
    plan.no_discontinuities = "no source gives more than the tolerance of all light";
  if (plan.no_discontinuities.empty()) plan.no_eee = eee_needless(scene, exchanging, options);
  return plan;
}

std::string discontinuities_needless(const SoundScene& scene, std::span<const int> exchanging,
                                     const SolveOptions& options) {
  const DiscontinuityOptions& events = options.events;
  if (!options.discontinuities || !(events.contact || events.face || events.ev || events.eee))
    return "they were not asked for";
  if (options.force.discontinuities) return {};
  if (is_convex(scene, exchanging)) return "no surface can come between two others";
  return most_surfaces_emit(scene);
}

std::string eee_needless(const SoundScene& scene, std::span<const int> exchanging,
                         const SolveOptions& options) {
  if (options.force.eee) return {};
  return is_one_convex_body(scene, blocking_surfaces(scene, exchanging, {}))
             ? "what can come between is one convex body"
             : "";
}

std::string factors_needless(const SoundScene& scene, bool is_exact, const SolveOptions& options) {
  if (!is_exact || options.force.factors) return {};
  if (options.radiosity.bounces == 0) return "no reflected light was asked for";
  const bool reflects =
      std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& surface) {
        return (scene.materials[at(surface.material)].rho > 0).any();
      });
  return reflects ? "" : "no surface reflects";
}

std::string channels_needless(const SoundScene& scene, const SolveOptions& options) {
  if (options.force.channels) return {};
  const auto is_grey = [](const Rgb& values) { return (values == values[0]).all(); };
  const bool grey =
      std::all_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& surface) {
        const Material& material = scene.materials[at(surface.material)];
        return is_grey(material.rho) && is_grey(material.exitance) &&
               (surface.paint < 0 || halfshade::is_grey(*scene.paints[at(surface.paint)].texture));
      });
  return grey ? "every material is grey" : "";
}

std::string direct_light_needless(const SoundScene& scene, DirectLightBy choice) {
  if (choice == DirectLightBy::exact) return {};
  if (choice == DirectLightBy::matrix) return "the matrix was asked for";
  return most_surfaces_emit(scene);
}

bool is_convex(const SoundScene& scene, std::span<const int> ids) {
  const auto is_behind = [&](const Surface& viewer, const Surface& other) {
    const Ring& ring = other.rings.front();
    return std::any_of(ring.begin(), ring.end(), [&](const Vec2& p) {
      return viewer.frame.height(other.frame.to_space(p)) < -tolerance_of(viewer, other).length;
    });
  };
  for (const int viewer : ids)
    for (const int other : ids)
      if (is_behind(scene.surfaces[at(viewer)], scene.surfaces[at(other)])) return false;
  return true;
}

double affordable_work(double tolerance) { return tolerance > 0 ? most_work : 0; }

double mean_direct_irradiance(const PreparedScene& prepared, const Progress& progress) {
  const SoundScene& scene = prepared.scene();
  const SpreadPlaces at_places = spread_places(scene, lit_surfaces(scene, hardly_lit),
                                               has_many_lines(scene) ? few_places : places);
  // Some of them first, which tell what all would take.
  const std::size_t count = at_places.points.size(), step = std::max(count / few_places, at(1));
  double power = 0, reached = 0;
  std::size_t work = 0;
  const auto add = [&](bool is_first) {
    std::vector<SurfacePoint> points;
    std::vector<double> areas;
    for (std::size_t k = 0; k < count; ++k) {
      if ((k % step == 0) != is_first) continue;
      points.push_back(at_places.points[k]);
      areas.push_back(at_places.area[k]);
    }
    const std::vector<DirectLight> light = prepared.direct_light().irradiance(points, progress);
    for (std::size_t k = 0; k < light.size(); ++k) {
      work += light[k].crowd_work;
      const double irradiance = light[k].irradiance.maxCoeff();
      if (!(irradiance > 0)) continue;
      power += areas[k] * irradiance;
      reached += areas[k];
    }
    return points.size();
  };
  const std::size_t first = add(true);
  if (work <= much_work * first || !(reached > 0)) add(false);
  if (reached > 0) return power / reached;
  return mean_over_lit_area(
      prepared, [](const Rgb& light) { return light.maxCoeff(); }, progress);
}

}  // namespace halfshade
