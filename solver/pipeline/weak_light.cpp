#include "solver/pipeline/weak_light.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/rays/visibility.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/adapt/field_beginnings.h"
#include "solver/direct/direct_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace halfshade {
namespace {

/// In scenes of fewer surfaces exactly visible parts are found at once.
constexpr std::size_t surfaces_for_rays = 2000;
/// Rays to an emitter, and patterns that they may go in.
constexpr int rays_each = 8;
constexpr std::size_t patterns = 16;
/// Of the square of an emitter's light: the mean square error of the share that so many evenly
/// spread places tell. A straight shadow over a square is off by 1/n^¾ of it (0.21 in the mean
/// square for one place), and at most points there is none.
constexpr double variance = 0.1 * 0.044;  // 8^-1.5

/// Places on a surface, as many for equal areas.
std::vector<Vec3> places_on(const Surface& surface, std::size_t pattern) {
  std::vector<Vec2> corners;
  for (const Ring& ring : surface.rings) corners.insert(corners.end(), ring.begin(), ring.end());
  const double each = area(surface) / rays_each;
  double passed = 0;
  std::vector<Vec3> places;
  for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
    const Vec2 &a = corners[at(i)], u = corners[at(j)] - a, v = corners[at(k)] - a;
    passed += 0.5 * std::abs(cross_2d(u, v));
    while ((static_cast<double>(places.size()) + 0.5) * each < passed) {
      const TrianglePlace place = spread_place(pattern * rays_each + places.size());
      places.push_back(surface.frame.to_space(a + place.x() * u + place.y() * v));
    }
  }
  return places;
}

}  // namespace

WeakLight::WeakLight(const PreparedScene& prepared, double noise)
    : prepared_(prepared), noise_(noise) {
  const SoundScene& scene = prepared.scene();
  for (const int s : prepared.direct_light().emitters()) {
    const Surface& surface = scene.surfaces[at(s)];
    Emitter emitter{s, scene.materials[at(surface.material)].exitance, {}, {}};
    for (std::size_t k = 0; k < patterns; ++k) emitter.places.push_back(places_on(surface, k));
    for (const Ring& ring : surface.rings) {
      auto& corners = emitter.rings.emplace_back();
      for (const Vec2& p : ring) corners.push_back(surface.frame.to_space(p));
    }
    emitters_.push_back(std::move(emitter));
  }
}

std::vector<WeakLight::Share> WeakLight::shares(const SurfacePoint& point) const {
  std::vector<Share> shares;
  for (const Emitter& emitter : emitters_) {
    const double factor = unobstructed_factor(point.position, point.normal, emitter.rings);
    if (factor > 0) shares.push_back({&emitter, factor, factor * emitter.exitance.matrix().norm()});
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.size < b.size; });
  return shares;
}

/// False if none of its places lies before the point.
bool WeakLight::add_by_rays(const FieldPoint& at_point, const Share& share, std::size_t pattern,
                            Rgb& light) const {
  const SurfacePoint& point = at_point.point;
  const Surface& surface = prepared_.scene().surfaces[at(share.emitter->surface)];
  const int from_plane =
      at_point.surface < 0 ? -1 : prepared_.scene().surfaces[at(at_point.surface)].plane;
  double all = 0, seen = 0;
  for (const Vec3& place : share.emitter->places[pattern % patterns]) {
    const Vec3 along = place - point.position;
    const double weight = point.normal.dot(along) * -surface.frame.normal.dot(along) /
                          std::pow(along.squaredNorm(), 2);
    if (!(weight > 0)) continue;
    all += weight;
    if (!prepared_.visibility().blocked({point.position, place, from_plane, surface.plane}))
      seen += weight;
  }
  if (all > 0) light += share.factor * (seen / all) * share.emitter->exitance;
  return all > 0;
}

WeakLight::Light WeakLight::irradiance(const FieldPoint& point) const {
  Light light;
  std::vector<int> exact;
  double square = 0;
  std::uint64_t pattern = 0;
  for (const double x : point.point.position)
    pattern = mix_bits(pattern ^ std::bit_cast<std::uint64_t>(x));
  for (const Share& share : shares(point.point)) {
    square += variance * share.size * share.size;
    pattern = mix_bits(pattern);
    if (square > noise_ * noise_ || !add_by_rays(point, share, pattern, light.irradiance))
      exact.push_back(share.emitter->surface);
  }
  const DirectLight strong = prepared_.direct_light().irradiance(point.point, exact);
  light.irradiance += strong.irradiance;
  light.crowd_work = strong.crowd_work;
  return light;
}

bool has_weak_light(const SoundScene& scene) {
  const auto emits = [&](const Surface& surface) {
    return (scene.materials[at(surface.material)].exitance > 0).any();
  };
  return scene.surfaces.size() > surfaces_for_rays &&
         std::count_if(scene.surfaces.begin(), scene.surfaces.end(), emits) > 1;
}

}  // namespace halfshade
