#include "meshing/triangulation/ring_triangles.h"

#include "meshing/core/planar.h"
#include "meshing/triangulation/planar_mesh.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Corners that turn by less than this, relative to the widest, may be straight or reflex.
constexpr double clearly_convex = 1e-6;

bool is_convex_quad(const Ring& ring) {
  if (ring.size() != 4) return false;
  double least = HUGE_VAL, most = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& a = ring[k];
    const double area = cross_2d(ring[(k + 1) % 4] - a, ring[(k + 2) % 4] - a);
    least = std::min(least, area);
    most = std::max(most, area);
  }
  return least > clearly_convex * most;
}

/// The corner nearest to a point, the first of several.
int nearest_corner(std::span<const Ring> rings, const Vec2& p) {
  double least = HUGE_VAL;
  int corner = 0, found = -1;
  for (const Ring& ring : rings)
    for (const Vec2& q : ring) {
      if (const double d = (q - p).squaredNorm(); d < least) {
        least = d;
        found = corner;
      }
      ++corner;
    }
  return found;
}

}  // namespace

std::vector<std::array<int, 3>> ring_triangles(std::span<const Ring> rings) {
  if (rings.size() == 1) {
    if (rings[0].size() < 3) return {};
    if (rings[0].size() == 3) return {{0, 1, 2}};
    if (is_convex_quad(rings[0])) return {{0, 1, 2}, {0, 2, 3}};
  }
  const PlanarMesh mesh = triangulate(rings, {});
  std::vector<int> corner;
  for (const Vec2& p : mesh.points) corner.push_back(nearest_corner(rings, p));
  std::vector<std::array<int, 3>> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({corner[at(a)], corner[at(b)], corner[at(c)]});
  return triangles;
}

}  // namespace halfshade
