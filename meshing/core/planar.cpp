#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>

namespace halfshade {

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(along) / length, 0., 1.) : 0;
  return (a + t * along - p).norm();
}

double distance_to_rings(std::span<const std::vector<Vec2>> rings, const Vec2& p) {
  double least = HUGE_VAL;
  for (const std::vector<Vec2>& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k)
      least = std::min(least, distance_to_segment(p, ring[k], ring[(k + 1) % ring.size()]));
  return least;
}

bool is_inside(std::span<const std::vector<Vec2>> rings, const Vec2& p) {
  bool odd = false;
  for (const std::vector<Vec2>& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) odd = !odd;
    }
  return odd;
}

}  // namespace halfshade
