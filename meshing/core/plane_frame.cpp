#include "meshing/core/plane_frame.h"

#include "meshing/core/error.h"

#include <cmath>

namespace halfshade {

Vec3 area_vector(std::span<const Vec3> polygon) {
  // Relative to the first corner, so that a polygon far from the origin loses no digits.
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return 0.5 * sum;
}

PlaneFrame make_frame(const Vec3& origin, const Vec3& normal) {
  const double length = normal.stableNorm();
  if (!(length > 0)) throw Error(ErrorCode::contract, "make_frame", "the normal has length zero");
  PlaneFrame frame;
  frame.origin = origin;
  frame.normal = normal / length;
  // The axis farthest from the normal gives the best-conditioned tangent.
  // The first of equally far ones, however the normal is rounded.
  constexpr double equal = 1e-9;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(frame.normal[k]) < std::abs(frame.normal[axis]) - equal) axis = k;
  frame.e1 = Vec3::Unit(axis).cross(frame.normal).normalized();
  frame.e2 = frame.normal.cross(frame.e1);
  return frame;
}

PlaneFrame fit_plane(std::span<const Vec3> polygon) {
  Vec3 offset = Vec3::Zero();
  for (const Vec3& p : polygon) offset += p - polygon[0];
  return make_frame(polygon[0] + offset / static_cast<double>(polygon.size()),
                    area_vector(polygon));
}

std::vector<Vec3> clip_to_front(std::span<const Vec3> polygon, const Vec3& plane_point,
                                const Vec3& normal) {
  std::vector<Vec3> kept;
  kept.reserve(polygon.size() + 1);
  bool inside_somewhere = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double height_a = normal.dot(a - plane_point);
    const double height_b = normal.dot(b - plane_point);
    if (height_a >= 0) kept.push_back(a);
    if (height_a > 0) inside_somewhere = true;
    if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0))
      kept.push_back(a + (height_a / (height_a - height_b)) * (b - a));
  }
  if (!inside_somewhere || kept.size() < 3) kept.clear();
  return kept;
}

}  // namespace halfshade
