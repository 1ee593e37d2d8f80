#include "solver/pipeline/direct_rays.h"

#include "solver/direct/direct_light.h"
#include "solver/pipeline/spread_places.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Fewer surfaces are looked through as quickly as by rays; at smaller tolerances polynomials
/// of higher orders need fewer places.
constexpr std::size_t many_surfaces = 100;
constexpr double loose = 0.01;
constexpr int tried_places = 100;
/// What counts of an exact look, and of one where so much lies before an emitter that it is cut
/// into cells, take in rays; see SightEffort and DirectLight::crowd_work.
constexpr double rays_of_look = 8, rays_of_turn = 0.15, rays_of_exact_turn = 2, rays_of_box = 0.03,
                 rays_of_crowd = 3;
/// Of the tolerance: standard deviation of a value, relative to the mean irradiance.
constexpr double deviation_for_tolerance = 1.5;
/// A place may take so much of what an exact look takes: rays do with half the places or fewer.
constexpr double as_quick = 1;

}  // namespace

RayLightOptions direct_rays(const PreparedScene& prepared, const SolveOptions& options,
                            const Progress& progress) {
  const SoundScene& scene = prepared.scene();
  if (options.method != SolveMethod::fields || options.refine != Refinement::adaptive ||
      options.visibility == ReflectedVisibility::exact || !options.goal.empty() ||
      options.force.discontinuities || options.force.exact_direct_light || options.order >= 0 ||
      options.tolerance < loose || scene.surfaces.size() < many_surfaces)
    return {};
  const std::vector<SurfacePoint> points = spread_places(scene, tried_places).points;
  SightEffort effort;
  double crowd_work = 0, sum = 0, reached = 0;
  for (const DirectLight& light : prepared.direct_light().irradiance(points, progress)) {
    effort += light.effort;
    crowd_work += static_cast<double>(light.crowd_work);
    const double irradiance = light.irradiance.mean();
    if (!(irradiance > 0)) continue;
    sum += irradiance;
    ++reached;
  }
  if (!(reached > 0) || progress.stopped()) return {};
  const double exact = rays_of_look * static_cast<double>(effort.looks) +
                       rays_of_turn * static_cast<double>(effort.turns) +
                       rays_of_exact_turn * static_cast<double>(effort.exact_turns) +
                       rays_of_box * static_cast<double>(effort.boxes) + rays_of_crowd * crowd_work;
  RayLightOptions rays;
  rays.deviation = deviation_for_tolerance * options.tolerance * sum / reached;
  rays.most_rays = std::max(exact / static_cast<double>(effort.looks), 1.);
  const RayLight light(scene, prepared.direct_light(), prepared.visibility(), rays);
  double by_rays = 0;
  for (const SurfacePoint& point : points) by_rays += light.cost(point);
  return by_rays < as_quick * exact ? rays : RayLightOptions{};
}

}  // namespace halfshade
