#include "solver/direct/emitter_target.h"

namespace halfshade {
namespace {

/// An emitter is passed over without asking the exact predicates only if it lies below the horizon,
/// or the point behind it, by more than this times the coordinates' size.
constexpr double clearly = 1e-12;

}  // namespace

EmitterTarget make_emitter_target(const SoundScene& scene, const Surface& surface) {
  EmitterTarget target;
  Eigen::AlignedBox3d box;
  for (const Ring& ring : surface.rings) {
    std::vector<Vec3>& corners = target.rings.emplace_back();
    for (const Vec2& p : ring) {
      corners.push_back(surface.frame.to_space(p));
      box.extend(corners.back());
    }
  }
  target.centre = box.center();
  target.half = 0.5 * box.sizes();
  target.origin = surface.frame.origin;
  target.normal = surface.frame.normal;
  target.exitance = scene.materials[at(surface.material)].exitance;
  target.strength = target.exitance.mean();
  target.scale = target.centre.lpNorm<1>() + target.half.lpNorm<1>();
  return target;
}

bool is_clearly_away(const EmitterTarget& target, const SurfacePoint& point) {
  const double margin = clearly * (target.scale + point.position.lpNorm<1>());
  if (target.normal.dot(point.position - target.origin) < -margin) return true;
  const double highest =
      point.normal.dot(target.centre - point.position) + point.normal.cwiseAbs().dot(target.half);
  return highest < -margin;
}

}  // namespace halfshade
