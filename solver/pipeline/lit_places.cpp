#include "solver/pipeline/lit_places.h"

#include "meshing/core/plane_frame.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/rays/visibility.h"
#include "solver/pipeline/spread_places.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace halfshade {
namespace {

/// Two random numbers make a direction away from a surface, as likely as the cosine is large.
Vec3 leaving_direction(const Vec3& normal, double s, double t) {
  const PlaneFrame frame = make_frame(Vec3::Zero(), normal);
  const double angle = 2 * std::numbers::pi * t;
  return frame.to_space(std::sqrt(s) * Vec2(std::cos(angle), std::sin(angle))) +
         std::sqrt(1 - s) * normal;
}

}  // namespace

std::vector<SurfacePoint> lit_places(const PreparedScene& prepared, int count) {
  const SoundScene& scene = prepared.scene();
  const VisibilityIndex& visibility = prepared.visibility();
  std::vector<SurfacePoint> result;
  std::uint64_t numbers = 0;
  for (const SurfacePoint& from :
       spread_places(scene, prepared.direct_light().emitters(), count).points) {
    const double s = unit_share(mix_bits(numbers++)), t = unit_share(mix_bits(numbers++));
    const Vec3 way = leaving_direction(from.normal, s, t);
    const auto hit = visibility.first_hit(from.position, way);
    if (!hit) continue;
    const PlaneFrame& frame = scene.surfaces[at(hit->owner)].frame;
    if (frame.normal.dot(way) < 0)
      result.push_back({frame.foot(from.position + hit->distance * way), frame.normal});
  }
  return result;
}

}  // namespace halfshade
