#include "solver/pipeline/direct_work.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace halfshade {
namespace {

/// For each unknown that there may be.
constexpr double crowd_work_for_one = 60, rays_for_one = 200;

}  // namespace

double work_done(const DirectWork& work, int unknowns) {
  return std::max(work.crowd / (crowd_work_for_one * unknowns),
                  work.rays / (rays_for_one * unknowns));
}

double places_left(const DirectWork& work, int unknowns) {
  const double done = work_done(work, unknowns);
  return done > 0 ? (1 / done - 1) * work.places : std::numeric_limits<double>::infinity();
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
    work.places += static_cast<double>(points.size());
    for (const DirectLight& light : index.irradiance(places, progress)) {
      values.push_back(light.irradiance);
      work.crowd += static_cast<double>(light.crowd_work);
    }
    return values;
  };
}

void try_middles(const ElementTable& elements, const FieldAt& light, const Progress& progress) {
  constexpr int many_elements = 10000, tried = 100;
  if (elements.count() < many_elements) return;
  std::vector<FieldPoint> middles;
  for (int e = 0; e < elements.count(); e += elements.count() / tried)
    middles.push_back({{position(elements.triangle(e), {1. / 3, 1. / 3}), elements.normal[at(e)]},
                       elements.surface[at(e)]});
  light(middles, progress);
}

NoisyFieldAt direct_light_at(const SoundScene& scene, const RayLight& light, DirectWork& work) {
  return [&](std::span<const FieldPoint> points, std::span<const double> slack,
             const Progress& progress) {
    std::vector<FieldPoint> places;
    places.reserve(points.size());
    for (const FieldPoint& point : points) places.push_back(in_own_plane(scene, point));
    RayIrradiance found = light.irradiance(places, slack, progress);
    work.places += static_cast<double>(points.size());
    work.rays += static_cast<double>(found.rays);
    return std::move(found.at);
  };
}

}  // namespace halfshade
