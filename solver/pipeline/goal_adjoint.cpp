#include "solver/pipeline/goal_adjoint.h"

#include "solver/elements/painted_triangle.h"

#include <algorithm>
#include <cstdint>

namespace halfshade {
namespace {

/// What is claimed grows by what weights may be off.
constexpr double for_the_adjoint = 1.1;
/// Of the mean that the adjoint light tells, what errors are relative to before it is known better.
constexpr double surely = 0.9;

/// Of rays: noise that z has in common with a residual at the same point would not average out.
constexpr std::uint64_t own_pattern = 1;

/// The same scene in which the group alone shines; black if nothing is reflected.
SoundScene lit_by_group(const SoundScene& scene, int group, int bounces) {
  SoundScene result = scene;
  const std::size_t count = result.materials.size();
  for (std::size_t m = 0; m < count; ++m) {
    if (bounces == 0) result.materials[m].rho = Rgb::Zero();
    result.materials[m].exitance = Rgb::Zero();
    Material shining = result.materials[m];
    shining.exitance = Rgb::Ones();
    result.materials.push_back(std::move(shining));
  }
  for (Surface& surface : result.surfaces)
    if (surface.group == group) surface.material += static_cast<int>(count);
  return result;
}

SolveOptions adjoint_options(const SolveOptions& options) {
  SolveOptions result = options;
  result.goal.clear();
  result.tolerance = adjoint_tolerance;
  result.refine = Refinement::adaptive;
  result.order = -1;
  result.secondary = 0;
  result.regions = result.each_bounce = false;
  result.force = {};
  // What arrives leaves after one reflection more.
  if (result.radiosity.bounces > 0) --result.radiosity.bounces;
  return result;
}

}  // namespace

GoalAdjoint::GoalAdjoint(const SoundScene& scene, int group, const SolveOptions& options,
                         const Progress& progress)
    : scene_(scene),
      group_(group),
      area_(area_of_group(scene, group)),
      lit_(lit_by_group(scene, group, options.radiosity.bounces)),
      light_(solve(lit_, adjoint_options(options), progress)),
      irradiance_(light_.elements, light_.irradiance) {}

double GoalAdjoint::exitance(int surface) const {
  return lit_.scene().surfaces[at(surface)].group == group_ ? 1 : 0;
}

Rgb GoalAdjoint::rho(int surface, const Vec3& position) const {
  return reflectance_at(lit_.scene(), lit_.scene().surfaces[at(surface)], position);
}

Rgb GoalAdjoint::leaving(int surface, const Vec3& position) const {
  return exitance(surface) + rho(surface, position) * irradiance_(surface, position);
}

GoalAdjoint::Importance GoalAdjoint::exactly(int surface, const SurfacePoint& point,
                                             int rays) const {
  const Rgb reflected = rho(surface, point.position);
  if ((reflected == 0).all()) return {Rgb::Zero(), Rgb::Constant(exitance(surface))};
  const ReflectedLight* more = light_.reflected_light ? &*light_.reflected_light : nullptr;
  Rgb arriving = Rgb::Zero();
  if (!more || !more->report().through_operator)
    arriving = lit_.direct_light().irradiance(point).irradiance;
  if (more) arriving += more->gather_on(surface, point.position, rays, own_pattern);
  return {arriving, exitance(surface) + reflected * arriving};
}

double GoalAdjoint::integral() const {
  double sum = 1;
  for (int e = 0; e < light_.elements.count(); ++e) {
    const Surface& surface = lit_.scene().surfaces[at(light_.elements.surface[at(e)])];
    const Rgb reflected =
        mean_reflected(lit_.scene(), surface, light_.elements, light_.irradiance, e);
    sum += light_.elements.area[at(e)] / area_ * std::max(reflected.maxCoeff(), 0.);
  }
  return sum;
}

Rgb GoalAdjoint::goal() const {
  Rgb sum = Rgb::Zero();
  for (int e = 0; e < light_.elements.count(); ++e) {
    const Surface& surface = scene_.surfaces[at(light_.elements.surface[at(e)])];
    sum += light_.elements.area[at(e)] / area_ * light_.solution.irradiance.row(e).transpose() *
           scene_.materials[at(surface.material)].exitance;
  }
  return sum;
}

GoalWeights weights_of(std::shared_ptr<const GoalAdjoint> adjoint) {
  GoalWeights result{adjoint->group(), {}, surely * adjoint->goal().matrix().norm()};
  if (!(result.norm > 0)) return result;
  const double factor = for_the_adjoint * for_the_adjoint * adjoint->integral() / adjoint->area();
  result.weight = [adjoint = std::move(adjoint), factor](int surface, const Vec3& position) {
    return factor * adjoint->leaving(surface, position).maxCoeff();
  };
  return result;
}

}  // namespace halfshade
