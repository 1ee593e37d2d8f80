#include "solver/pipeline/direct_work.h"

#include <utility>

namespace halfshade {
namespace {

/// For each unknown that there may be.
constexpr double crowd_work_for_one = 60, rays_for_one = 150;

}  // namespace

bool is_too_much(const DirectWork& work, int unknowns) {
  return work.crowd > crowd_work_for_one * unknowns || work.rays > rays_for_one * unknowns;
}

namespace {

FieldPoint in_own_plane(const SoundScene& scene, const FieldPoint& point) {
  const PlaneFrame& frame = scene.surfaces[at(point.surface)].frame;
  return {{frame.foot(point.point.position), point.point.normal}, point.surface};
}

}  // namespace

FieldAt direct_light_at(const SoundScene& scene, const DirectLightIndex& index, DirectWork& work) {
  return [&](std::span<const FieldPoint> points, const Progress& progress) {
    std::vector<SurfacePoint> places;
    places.reserve(points.size());
    for (const FieldPoint& point : points) places.push_back(in_own_plane(scene, point).point);
    std::vector<Rgb> values;
    values.reserve(points.size());
    for (const DirectLight& light : index.irradiance(places, progress)) {
      values.push_back(light.irradiance);
      work.crowd += static_cast<double>(light.crowd_work);
    }
    return values;
  };
}

NoisyFieldAt direct_light_at(const SoundScene& scene, const RayLight& light, DirectWork& work) {
  return [&](std::span<const FieldPoint> points, std::span<const double> slack,
             const Progress& progress) {
    std::vector<FieldPoint> places;
    places.reserve(points.size());
    for (const FieldPoint& point : points) places.push_back(in_own_plane(scene, point));
    RayIrradiance found = light.irradiance(places, slack, progress);
    work.rays += static_cast<double>(found.rays);
    return std::move(found.at);
  };
}

}  // namespace halfshade
