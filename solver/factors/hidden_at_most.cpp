#include "solver/factors/blocked_cell.h"

#include <algorithm>
#include <span>

namespace halfshade {
namespace {

double size_of_triangle(const Triangle3& t) {
  return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
}

Polygon3 clipped(Polygon3 polygon, const Shaft& shaft) {
  for (const Shaft::Side& side : shaft.sides) {
    if (polygon.empty()) break;
    polygon = clip_to_front(polygon, side.limit * side.normal, -side.normal);
  }
  return polygon;
}

/// From a point to either side of a polygon.
double factor_to(const Vec3& point, const Vec3& normal, const Polygon3& polygon) {
  const Polygon3 turned(polygon.rbegin(), polygon.rend());
  return std::max(point_to_polygon(point, normal, polygon),
                  point_to_polygon(point, normal, turned));
}

Vec3 middle_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// What lies over or under a cell.
Polygon3 above(const Triangle3& cell, const Vec3& normal, Polygon3 polygon) {
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    const Vec3 &from = cell[k], &to = cell[(k + 1) % 3], &third = cell[(k + 2) % 3];
    const Vec3 inwards = normal.cross(to - from);
    polygon = clip_to_front(polygon, from, inwards.dot(third - from) < 0 ? -inwards : inwards);
  }
  return polygon;
}

/// Mutual area of a cell and a polygon, as the middle of the polygon sees the cell from either
/// side.
double seen_from_middle(const Polygon3& polygon, const Triangle3& cell) {
  if (polygon.empty()) return 0;
  const Vec3 area = area_vector(polygon);
  const double size = area.norm();
  if (!(size > 0)) return 0;
  const Polygon3 outline(cell.begin(), cell.end());
  const Vec3 middle = middle_of(polygon), up = area / size;
  return size * std::max(factor_to(middle, up, outline), factor_to(middle, -up, outline));
}

/// Mutual area of a cell and what may hide something from it, seen from both: one of them has
/// points near enough to see it well. Close above a part of the cell only what is over that does.
double hidden_by(const Triangle3& cell, const Vec3& normal, const Polygon3& blocker) {
  double most = factor_to(middle_of(cell), normal, blocker);
  for (const Vec3& corner : cell) most = std::max(most, factor_to(corner, normal, blocker));
  return std::max({size_of_triangle(cell) * most, seen_from_middle(blocker, cell),
                   seen_from_middle(above(cell, normal, blocker), cell)});
}

bool is_outside(const Shaft& shaft, const Ball& ball) {
  return std::any_of(shaft.sides.begin(), shaft.sides.end(), [&](const Shaft::Side& side) {
    return side.normal.dot(ball.centre) - ball.radius > side.limit;
  });
}

}  // namespace

double hidden_at_most(const Shaft& shaft, const Triangle3& part, const Vec3& normal,
                      const Blocker& blocker) {
  if (is_outside(shaft, blocker.ball)) return 0;
  const Polygon3 between = clipped(blocker.corners, shaft);
  return between.empty() ? 0 : hidden_by(part, normal, between);
}

double hidden_from_above(const Shaft& shaft, const Triangle3& part, const Vec3& normal,
                         const Blocker& blocker) {
  return seen_from_middle(above(part, normal, clipped(blocker.corners, shaft)), part);
}

double hidden_at_most(const SightScene& scene, const Triangle3& part, int a, int b, double enough) {
  const PlaneFrame& plane = scene.surfaces[at(a)].frame;
  double sum = 0;
  for (const Polygon3& piece : scene.surfaces[at(b)].pieces) {
    const Polygon3 other = clip_to_front(piece, plane.origin, plane.normal);
    if (other.empty()) continue;
    const std::vector<int> triangles = triangles_between(scene, part, a, other, b);
    if (triangles.empty()) continue;
    const Shaft shaft = make_shaft(part, other, 0);
    const TriangleSoup& soup = scene.between.soup();
    for (const int t : triangles) {
      const auto& [i, j, k] = soup.triangles[at(t)];
      const Polygon3 between =
          clipped({soup.points[at(i)], soup.points[at(j)], soup.points[at(k)]}, shaft);
      if (!between.empty()) sum += hidden_by(part, plane.normal, between);
      if (sum > enough) return sum;
    }
  }
  return sum;
}

}  // namespace halfshade
