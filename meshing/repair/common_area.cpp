#include "meshing/repair/common_area.h"

#include "meshing/arrangement/overlay.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace halfshade {
namespace {

double length_round(std::span<const Vec3> polygon) {
  double sum = (polygon.front() - polygon.back()).norm();
  for (std::size_t k = 1; k < polygon.size(); ++k) sum += (polygon[k] - polygon[k - 1]).norm();
  return sum;
}

/// Whether a line along an axis of the plane parts the polygons but for a width.
bool are_beside(std::span<const Vec2> a, std::span<const Vec2> b, double width) {
  Eigen::AlignedBox2d of_a, of_b;
  for (const Vec2& p : a) of_a.extend(p);
  for (const Vec2& p : b) of_b.extend(p);
  return (of_a.intersection(of_b).sizes().array() <= width).any();
}

}  // namespace

bool have_common_area(std::span<const Vec3> a, std::span<const Vec3> b, const PlaneFrame& plane,
                      const LocalTolerance& tolerance) {
  std::vector<Vec2> flat;
  for (const Vec3& p : a) flat.push_back(plane.to_plane(p));
  for (const Vec3& p : b) flat.push_back(plane.to_plane(p));
  const std::span<const Vec2> corners = flat;
  if (are_beside(corners.first(a.size()), corners.subspan(a.size()), tolerance.planarity))
    return false;
  std::vector<std::vector<int>> loops = {std::vector<int>(a.size()), std::vector<int>(b.size())};
  std::iota(loops[0].begin(), loops[0].end(), 0);
  std::iota(loops[1].begin(), loops[1].end(), static_cast<int>(a.size()));
  const Overlay both = overlay(flat, loops, {tolerance.length, tolerance.planarity});
  double area = 0;
  for (std::size_t t = 0; t < both.winding.size(); ++t)
    if (both.winding[t].size() == 2) area += twice_area(both.points, both.hull.triangles[t]) / 2;
  return area > tolerance.planarity * std::min(length_round(a), length_round(b));
}

}  // namespace halfshade
