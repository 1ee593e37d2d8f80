#include "solver/pipeline/spot_places.h"

#include "meshing/core/planar.h"
#include "solver/pipeline/middle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// A surface that is not larger than so many spots is sampled densely enough.
constexpr double large = 4;
/// Of them all.
constexpr std::size_t most_places = 50000;

/// Places at the same distance from the middle of a spot; lengths in sizes of the spot.
struct PlaceRing {
  double radius, inner, outer;
  int count;
};
constexpr std::array<PlaceRing, 4> place_rings = {
    {{0, 0, 0.3, 1}, {0.6, 0.3, 0.95, 6}, {1.3, 0.95, 1.9, 6}, {2.5, 1.9, 3.1, 6}}};

/// The point of a surface's plane that is inside and next to one in that plane.
Vec2 nearest_inside(const Surface& surface, const Vec2& p) {
  if (is_inside(surface.rings, p)) return p;
  Vec2 nearest = surface.rings.front().front();
  for (const Ring& ring : surface.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
      const Vec2 q = a + nearest_on_segment(p, a, b) * (b - a);
      if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
    }
  return nearest;
}

void add_places(const Surface& lamp, const Surface& surface, int id,
                std::vector<WatchedPlace>& places) {
  const Vec3 from = middle(lamp);
  const double height = surface.frame.height(from);
  if (!(height > 0)) return;
  const Vec2 below = surface.frame.to_plane(from), nearest = nearest_inside(surface, below);
  const double spot = std::max(std::hypot(height, (nearest - below).norm()), 0.5 * size_of(lamp));
  if (size_of(surface) < large * spot) return;
  for (const auto& [radius, inner, outer, count] : place_rings)
    for (int k = 0; k < count; ++k) {
      // Turned by something, so that no ring is in line with the next.
      const double angle = 2 * std::numbers::pi * (k + radius) / count;
      const Vec2 p = nearest + radius * spot * Vec2(std::cos(angle), std::sin(angle));
      const Vec3 position = surface.frame.to_space(p);
      if (is_inside(surface.rings, p) && lamp.frame.height(position) > 0)
        places.push_back(
            {{{position, surface.frame.normal}, id},
             std::numbers::pi * (outer * outer - inner * inner) * spot * spot / count});
    }
}

}  // namespace

std::vector<WatchedPlace> spot_places(const SoundScene& scene, std::span<const int> sources) {
  std::vector<WatchedPlace> places;
  for (const int source : sources)
    for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s)
      if (s != source && places.size() < most_places)
        add_places(scene.surfaces[at(source)], scene.surfaces[at(s)], s, places);
  return places;
}

}  // namespace halfshade
