#include "solver/exchange/enclosures.h"

#include "meshing/core/parallel.h"
#include "meshing/core/plane_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Rays an element sends out to find an opening.
constexpr int rays_per_element = 64;
/// Exchange of less than this part of the smaller element's light does not connect enclosures: a
/// single sampled ray that slips along a contact line must not.
constexpr double weakest_link = 1e-6;

bool meets_a_front(const SoundScene& scene, const VisibilityIndex& visibility, const Vec3& origin,
                   const Vec3& direction) {
  const auto hit = visibility.first_hit(origin, direction);
  if (!hit) return false;
  const Surface& surface = scene.surfaces[static_cast<std::size_t>(hit->owner)];
  if (surface.frame.normal.dot(direction) < 0 ||
      scene.materials[static_cast<std::size_t>(surface.material)].two_sided)
    return true;
  // Where a ray meets the edge between a front and a back, either may be found first.
  const auto front = visibility.first_hit(origin, direction, Sides::front_only);
  return front && front->distance <= hit->distance + tolerance_of(surface).planarity;
}

/// True if every ray from the element meets the front of a surface.
bool sees_only_fronts(const SoundScene& scene, const ElementTable& elements,
                      const VisibilityIndex& visibility, int element) {
  const auto e = static_cast<std::size_t>(element);
  const auto t = elements.triangle(element);
  const Surface& surface = scene.surfaces[at(elements.surface[e])];
  const PlaneFrame frame =
      make_frame((t[0] + t[1] + t[2]) / 3 + tolerance_of(surface).planarity * elements.normal[e],
                 elements.normal[e]);
  for (int k = 0; k < rays_per_element; ++k) {
    // Cosine-distributed directions on a spiral (Vogel 1979): equal shares of the projected
    // hemisphere.
    const double radius = std::sqrt((k + 0.5) / rays_per_element);
    const double angle = k * std::numbers::pi * (3 - std::sqrt(5.));
    const Vec3 direction = radius * std::cos(angle) * frame.e1 +
                           radius * std::sin(angle) * frame.e2 +
                           std::sqrt(1 - radius * radius) * frame.normal;
    if (!meets_a_front(scene, visibility, frame.origin, direction)) return false;
  }
  return true;
}

/// Gives `enclosure` to everything that is connected with `start`.
void flood(const ExchangeMatrix& matrix, const ElementTable& elements, int start, int enclosure,
           std::vector<int>& of_element) {
  std::vector<int> front = {start};
  of_element[static_cast<std::size_t>(start)] = enclosure;
  while (!front.empty()) {
    const int e = front.back();
    front.pop_back();
    for (ExchangeMatrix::InnerIterator entry(matrix, e); entry; ++entry) {
      const auto other = static_cast<std::size_t>(entry.col());
      const double smaller =
          std::min(elements.area[static_cast<std::size_t>(e)], elements.area[other]);
      if (of_element[other] >= 0 || entry.value() < weakest_link * smaller) continue;
      of_element[other] = enclosure;
      front.push_back(static_cast<int>(other));
    }
  }
}

}  // namespace

Enclosures find_enclosures(const SoundScene& scene, const ElementTable& elements,
                           const VisibilityIndex& visibility, const ExchangeMatrix& matrix) {
  const std::size_t n = elements.corners.size();
  std::vector<char> fronts(n);
  parallel_for(n, [&](std::size_t e) {
    fronts[e] = sees_only_fronts(scene, elements, visibility, static_cast<int>(e));
  });
  Enclosures enclosures;
  enclosures.of_element.assign(n, -1);
  for (std::size_t e = 0; e < n; ++e)
    if (enclosures.of_element[e] < 0) {
      flood(matrix, elements, static_cast<int>(e), enclosures.count(), enclosures.of_element);
      enclosures.closed.push_back(true);
      enclosures.lit.push_back(false);
    }
  for (std::size_t e = 0; e < n; ++e) {
    const auto k = static_cast<std::size_t>(enclosures.of_element[e]);
    if (!fronts[e]) enclosures.closed[k] = false;
    if ((scene.materials[static_cast<std::size_t>(elements.material[e])].exitance > 0).any())
      enclosures.lit[k] = true;
  }
  return enclosures;
}

}  // namespace halfshade
