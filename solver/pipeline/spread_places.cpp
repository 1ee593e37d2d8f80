#include "solver/pipeline/spread_places.h"

#include "meshing/core/planar.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/adapt/field_beginnings.h"

#include <cmath>

namespace halfshade {

SpreadPlaces spread_places(const SoundScene& scene, int count) {
  SpreadPlaces result;
  double all = 0;
  for (const Surface& surface : scene.surfaces) all += area(surface);
  const double each = all / count;
  double passed = 0;
  for (const Surface& surface : scene.surfaces) {
    std::vector<Vec2> corners;
    for (const Ring& ring : surface.rings) corners.insert(corners.end(), ring.begin(), ring.end());
    for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
      const Vec2 &a = corners[at(i)], u = corners[at(j)] - a, v = corners[at(k)] - a;
      passed += 0.5 * std::abs(cross_2d(u, v));
      while (static_cast<double>(result.points.size()) + 0.5 < passed / each) {
        const TrianglePlace place = spread_place(result.points.size());
        result.points.push_back(
            {surface.frame.to_space(a + place.x() * u + place.y() * v), surface.frame.normal});
        result.area.push_back(each);
      }
    }
  }
  return result;
}

}  // namespace halfshade
