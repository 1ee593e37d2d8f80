#include "solver/pipeline/lit_places.h"

#include "meshing/core/plane_frame.h"
#include "meshing/geometry/cosine_direction.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/rays/visibility.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/spread_places.h"

#include <cstdint>
#include <vector>

namespace halfshade {
namespace {

constexpr int tried_rays = 100;
/// Looks are made in so many batches, as long as they have not taken so much; see in_rays.
constexpr std::size_t batches = 10;
constexpr double most_lit_work = 5e6;

/// Where rays from the emitters meet the front of a surface.
std::vector<SurfacePoint> lit_places(const PreparedScene& prepared) {
  const SoundScene& scene = prepared.scene();
  const VisibilityIndex& visibility = prepared.visibility();
  std::vector<SurfacePoint> result;
  std::uint64_t numbers = 0;
  for (const SurfacePoint& from :
       spread_places(scene, prepared.direct_light().emitters(), tried_rays).points) {
    const double s = unit_share(mix_bits(numbers++)), t = unit_share(mix_bits(numbers++));
    const Vec3 way = cosine_direction(make_frame(Vec3::Zero(), from.normal), s, t);
    std::optional<Hit> hit = visibility.first_hit(from.position, way);
    if (hit && scene.surfaces[at(hit->owner)].frame.normal.dot(way) >= 0)
      hit = visibility.facing_hit({from.position, way}, *hit);
    if (!hit) continue;
    const PlaneFrame& frame = scene.surfaces[at(hit->owner)].frame;
    result.push_back({frame.foot(from.position + hit->distance * way), frame.normal});
  }
  return result;
}

}  // namespace

double mean_over_lit_area(const PreparedScene& prepared,
                          const std::function<double(const Rgb&)>& brightness,
                          const Progress& progress) {
  const std::vector<SurfacePoint> places = lit_places(prepared);
  double work = 0, inverse = 0, count = 0;
  // The first of them are spread like all.
  for (std::size_t first = 0; first < batches && work < most_lit_work; ++first) {
    std::vector<SurfacePoint> batch;
    for (std::size_t k = first; k < places.size(); k += batches) batch.push_back(places[k]);
    for (const DirectLight& light : prepared.direct_light().irradiance(batch, progress)) {
      work += in_rays(light.effort, static_cast<double>(light.crowd_work));
      const double bright = brightness(light.irradiance);
      if (!(bright > 0)) continue;
      inverse += 1 / bright;
      ++count;
    }
  }
  return count > 0 ? count / inverse : 0;
}

}  // namespace halfshade
