#include "solver/pipeline/spread_places.h"

#include "meshing/core/planar.h"
#include "meshing/core/rounded.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/adapt/field_beginnings.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

std::vector<Vec2> corners_of(const Surface& surface) {
  std::vector<Vec2> corners;
  for (const Ring& ring : surface.rings) corners.insert(corners.end(), ring.begin(), ring.end());
  return corners;
}

}  // namespace

SpreadPlaces spread_places(const SoundScene& scene, std::span<const int> ids, int count) {
  SpreadPlaces result;
  double all = 0;
  for (const int id : ids) all += area(scene.surfaces[at(id)]);
  const double each = all / count;
  double passed = 0;
  for (const int id : ids) {
    const Surface& surface = scene.surfaces[at(id)];
    const std::vector<Vec2> corners = corners_of(surface);
    for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
      const Vec2 &a = corners[at(i)], u = corners[at(j)] - a, v = corners[at(k)] - a;
      passed += 0.5 * std::abs(cross_2d(u, v));
      while (static_cast<double>(result.points.size()) + 0.5 < rounded(passed / each)) {
        const TrianglePlace place = spread_place(result.points.size());
        result.points.push_back(
            {surface.frame.to_space(a + place.x() * u + place.y() * v), surface.frame.normal});
        result.area.push_back(each);
      }
    }
  }
  return result;
}

std::vector<SurfacePoint> places_of_surfaces(const SoundScene& scene, std::span<const int> ids,
                                             int count) {
  const std::size_t all = ids.size(), most = std::min(all, static_cast<std::size_t>(count));
  std::vector<SurfacePoint> places;
  for (std::size_t n = 0; n < most; ++n) {
    const Surface& surface = scene.surfaces[at(ids[n * all / most])];
    const std::vector<Vec2> corners = corners_of(surface);
    double largest = -1;
    Vec2 middle = corners.front();
    for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
      const Vec2 &a = corners[at(i)], &b = corners[at(j)], &c = corners[at(k)];
      const double area = rounded(std::abs(cross_2d(b - a, c - a)));
      if (area <= largest) continue;
      largest = area;
      middle = (a + b + c) / 3;
    }
    places.push_back({surface.frame.to_space(middle), surface.frame.normal});
  }
  return places;
}

}  // namespace halfshade
