#include "solver/pipeline/corner_places.h"

#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Circles around a corner, each half as wide as the one before, and places on each.
constexpr int most_circles = 14, places_each = 8;
/// Corners as far from a surface as their edges are long are no touches.
constexpr double nearest = 0.5;
/// The places of a circle stand for the ring of √2 times more and less its radius.
constexpr double ring_area = 1.5 * M_PI;

/// What lies before a plane by less, of a surface's size, lies in it.
constexpr double in_plane = 1e-9;

bool reaches_before(const Surface& surface, const PlaneFrame& plane) {
  const double least = in_plane * size_of(surface);
  return std::any_of(
      surface.rings.front().begin(), surface.rings.front().end(),
      [&](const Vec2& p) { return plane.height(surface.frame.to_space(p)) > least; });
}

/// Whether light of one can fall on the other, were nothing between them.
bool face_each_other(const Surface& a, const Surface& b) {
  return reaches_before(a, b.frame) && reaches_before(b, a.frame);
}

double shorter_edge(const Ring& ring, std::size_t k) {
  const std::size_t n = ring.size();
  return std::min((ring[(k + 1) % n] - ring[k]).norm(), (ring[k] - ring[(k + n - 1) % n]).norm());
}

void surround(const Surface& surface, int id, const Vec2& centre, double widest, double least,
              std::vector<WatchedPlace>& places) {
  double radius = nearest * widest;
  for (int circle = 0; circle < most_circles && radius > least; ++circle, radius /= 2)
    for (int k = 0; k < places_each; ++k) {
      const double angle = 2 * M_PI * (k + 0.5 * (circle % 2) + 0.25) / places_each;
      const Vec2 place = centre + radius * Vec2(std::cos(angle), std::sin(angle));
      if (is_inside(surface.rings, place))
        places.push_back({{{surface.frame.to_space(place), surface.frame.normal}, id},
                          ring_area * radius * radius / places_each});
    }
}

}  // namespace

std::vector<WatchedPlace> corner_places(const SoundScene& scene, std::span<const int> sources) {
  std::vector<WatchedPlace> places;
  for (const int source : sources) {
    const Surface& emitter = scene.surfaces[at(source)];
    for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
      const Surface& surface = scene.surfaces[at(s)];
      if (s == source || !face_each_other(emitter, surface)) continue;
      for (const Ring& ring : emitter.rings)
        for (std::size_t k = 0; k < ring.size(); ++k) {
          const Vec3 corner = emitter.frame.to_space(ring[k]);
          const double length = shorter_edge(ring, k);
          const double height = std::abs(surface.frame.height(corner));
          if (height < nearest * length)
            surround(surface, s, surface.frame.to_plane(corner), length, height, places);
        }
    }
  }
  return places;
}

}  // namespace halfshade
