#include "solver/pipeline/goal_adjoint.h"

#include "solver/elements/painted_triangle.h"
#include "solver/pipeline/solve_options.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Of the adjoint light in the L2 norm: errors of weights only misplace effort.
constexpr double adjoint_tolerance = 0.025;
/// What is claimed grows by what weights may be off.
constexpr double for_the_adjoint = 1.1;
/// Of the mean that the adjoint light tells, what errors are relative to before it is known better.
constexpr double surely = 0.9;

/// The same scene in which the group alone shines.
SoundScene lit_by_group(const SoundScene& scene, int group) {
  SoundScene result = scene;
  const std::size_t count = result.materials.size();
  for (std::size_t m = 0; m < count; ++m) {
    result.materials[m].exitance = Rgb::Zero();
    Material shining = result.materials[m];
    shining.exitance = Rgb::Ones();
    result.materials.push_back(std::move(shining));
  }
  for (Surface& surface : result.surfaces)
    if (surface.group == group) surface.material += static_cast<int>(count);
  return result;
}

}  // namespace

ReflectedVisibility visibility_for_goal(const SoundScene& scene, ReflectedVisibility asked) {
  constexpr std::size_t few_surfaces = 100;  // their visible parts are found at once
  return asked == ReflectedVisibility::automatic && scene.surfaces.size() <= few_surfaces
             ? ReflectedVisibility::exact
             : asked;
}

Rgb GoalAdjoint::rho(int surface, const Vec3& position) const {
  return reflectance_at(scene, scene.surfaces[at(surface)], position);
}

Rgb GoalAdjoint::leaving(int surface, const Vec3& position) const {
  const Rgb reflected = rho(surface, position) * light.irradiance(surface, position).max(0);
  return scene.surfaces[at(surface)].group == group ? Rgb(1 + reflected) : reflected;
}

Rgb GoalAdjoint::leaving_exactly(int surface, const SurfacePoint& point, int rays) const {
  const double first = scene.surfaces[at(surface)].group == group ? 1 : 0;
  const Rgb reflected = rho(surface, point.position);
  if ((reflected == 0).all()) return Rgb::Constant(first);
  return first + reflected * light.gather(point, rays);
}

double GoalAdjoint::integral() const {
  double sum = 1;
  for (int e = 0; e < light.elements().count(); ++e) {
    const Rgb reflected = mean_reflected(scene, scene.surfaces[at(light.elements().surface[at(e)])],
                                         light.elements(), light.field(), e);
    sum += light.elements().area[at(e)] / area * std::max(reflected.maxCoeff(), 0.);
  }
  return sum;
}

Rgb GoalAdjoint::goal() const {
  Rgb sum = Rgb::Zero();
  const ChannelArray mean = means(light.field());
  for (int e = 0; e < light.elements().count(); ++e) {
    const Surface& surface = scene.surfaces[at(light.elements().surface[at(e)])];
    sum += light.elements().area[at(e)] / area * mean.row(e).transpose() *
           scene.materials[at(surface.material)].exitance;
  }
  return sum;
}

GoalAdjoint solve_adjoint(const SoundScene& scene, int group, const SolveOptions& options,
                          const Progress& progress) {
  ReflectedOptions how;
  how.visibility = visibility_for_goal(scene, options.visibility);
  how.tolerance = adjoint_tolerance;
  how.through_operator = true;
  // What arrives straight from the group arrives by the operator's first application.
  if (options.radiosity.bounces >= 0) how.bounces = options.radiosity.bounces + 1;
  return {scene, group, area_of_group(scene, group),
          reflected_light(lit_by_group(scene, group), {}, how, progress)};
}

GoalWeights weights_of(std::shared_ptr<const GoalAdjoint> adjoint) {
  GoalWeights result{adjoint->group, {}, surely * adjoint->goal().matrix().norm()};
  if (!(result.norm > 0)) return result;
  const double factor = for_the_adjoint * for_the_adjoint * adjoint->integral() / adjoint->area;
  result.weight = [adjoint = std::move(adjoint), factor](int surface, const Vec3& position) {
    return factor * adjoint->leaving(surface, position).maxCoeff();
  };
  return result;
}

}  // namespace halfshade
