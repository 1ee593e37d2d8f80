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
/// In sizes of the spot: places beside a border are half so far from it, or in the middle of what
/// is narrower.
constexpr double beside_border = 0.3;

/// A place of a surface, and how wide the surface is there, from border to border, if a border is
/// what it is next to.
struct InnerPlace {
  Vec2 place;
  double width = HUGE_VAL;
};

/// How far the border is from a point in a direction.
double next_border(const Surface& surface, const Vec2& p, const Vec2& direction) {
  constexpr double same = 1e-12;  // of the surface: the border that the point is on
  double nearest = HUGE_VAL;
  for (const Ring& ring : surface.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const auto distance = line_meets_segment(p, direction, ring[k], ring[(k + 1) % ring.size()]);
      if (distance && *distance > same * size_of(surface)) nearest = std::min(nearest, *distance);
    }
  return nearest;
}

/// The place next to a point of a surface's plane that is inside; if the point is not, half of the
/// width beside the border, or of `most`.
InnerPlace nearest_inside(const Surface& surface, const Vec2& p, double most) {
  if (is_inside(surface.rings, p)) return {p};
  Vec2 nearest = surface.rings.front().front(), inwards = Vec2::Zero();
  double least = HUGE_VAL;
  for (const Ring& ring : surface.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
      const Vec2 along = b - a, q = a + nearest_on_segment(p, a, b) * along;
      if (const double distance = (q - p).squaredNorm(); distance < least) {
        least = distance;
        nearest = q;
        inwards = Vec2(-along.y(), along.x()).normalized();
      }
    }
  const double width = next_border(surface, nearest, inwards);
  return {nearest + 0.5 * std::min(width, most) * inwards, width};
}

void add_places(const Surface& lamp, const Surface& surface, int id,
                std::vector<WatchedPlace>& places) {
  const Vec3 from = middle(lamp);
  const double height = surface.frame.height(from);
  if (!(height > 0)) return;
  const Vec2 below = surface.frame.to_plane(from),
             nearest = nearest_inside(surface, below, 0).place;
  const double spot = std::max(std::hypot(height, (nearest - below).norm()), 0.5 * size_of(lamp));
  if (size_of(surface) < large * spot) return;
  for (const auto& [radius, inner, outer, count] : place_rings)
    for (int k = 0; k < count; ++k) {
      // Turned by something, so that no ring is in line with the next.
      const double angle = 2 * std::numbers::pi * (k + radius) / count;
      const Vec2 wanted = nearest + radius * spot * Vec2(std::cos(angle), std::sin(angle));
      // Of something narrow, what lies beside it.
      const auto [p, width] = nearest_inside(surface, wanted, beside_border * spot);
      const double off = (p - nearest).norm() / spot;
      const Vec3 position = surface.frame.to_space(p);
      if (off > outer || off < inner || !is_inside(surface.rings, p) ||
          !(lamp.frame.height(position) > 0))
        continue;
      const double all = std::numbers::pi * (outer + inner),
                   across = std::min(all, 2 * width / spot);
      places.push_back(
          {{{position, surface.frame.normal}, id}, across * (outer - inner) * spot * spot / count});
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
