#include "solver/factors/row_place.h"

#include "meshing/core/planar.h"

#include <Eigen/Geometry>

namespace halfshade {
namespace {

/// Area times centroid of a surface, in its frame; from its first corner, so that digits stay.
Vec2 first_moment(const Surface& surface) {
  const Vec2 from = surface.rings.front().front();
  Vec2 sum = area(surface) * from;
  for (const Ring& ring : surface.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k] - from, b = ring[(k + 1) % ring.size()] - from;
      sum += cross_2d(a, b) / 6 * (a + b);
    }
  return sum;
}

}  // namespace

std::vector<RowPlace> row_places(const FactorScene& faces) {
  std::vector<RowPlace> places(faces.names.size());
  std::vector<Eigen::AlignedBox3d> boxes(faces.names.size());
  for (std::size_t s = 0; s < faces.sound.surfaces.size(); ++s) {
    if (faces.row[s] < 0) continue;
    const Surface& surface = faces.sound.surfaces[s];
    const std::size_t row = at(faces.row[s]);
    const double size = area(surface);
    places[row].centre +=
        size / faces.areas[row] * surface.frame.to_space(first_moment(surface) / size);
    places[row].normal += size * surface.frame.normal;
    for (const Ring& ring : surface.rings)
      for (const Vec2& corner : ring) boxes[row].extend(surface.frame.to_space(corner));
  }
  for (std::size_t row = 0; row < places.size(); ++row) {
    places[row].normal.normalize();
    places[row].extent = boxes[row].sizes();
  }
  return places;
}

}  // namespace halfshade
