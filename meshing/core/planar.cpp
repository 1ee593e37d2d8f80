#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>

namespace halfshade {

double nearest_on_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double square = along.squaredNorm();
  return square > 0 ? std::clamp(along.dot(p - a) / square, 0., 1.) : 0;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double s = nearest_on_segment(p, a, b);
  // From the nearer end, so that points at either end are exact.
  return s < 0.5 ? (p - a - s * along).norm() : (p - b + (1 - s) * along).norm();
}

std::optional<double> line_meets_segment(const Vec2& p, const Vec2& direction, const Vec2& a,
                                         const Vec2& b) {
  const double at_a = cross_2d(direction, a - p), at_b = cross_2d(direction, b - p);
  if ((at_a > 0) == (at_b > 0)) return std::nullopt;
  return direction.dot(a + at_a / (at_a - at_b) * (b - a) - p);
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
