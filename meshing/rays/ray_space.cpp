#include "meshing/rays/ray_space.h"

#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

// In [−1, 1] a line through a triangle is off by about ten roundings of single precision, 2^-20.
// Edges are moved outwards by four times that, and rays, whose ends suffer more at grazing angles,
// lengthened by much more.
constexpr double relative_enlargement = 0x1p-18;
constexpr double lengthening = 0x1p-12;

constexpr double largest_coordinate = 0.75;  // clear of the cube
constexpr double half_of_cube = 1 + 2 * lengthening;

/// Cuts a ray to the cube that holds all triangles, so that far end points cost no precision.
/// False if nothing is left.
bool clip_to_cube(Ray& ray) {
  double enter = 0, leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (std::abs(o) > half_of_cube) return false;
      continue;
    }
    const double t0 = (-half_of_cube - o) / d, t1 = (half_of_cube - o) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave)) return false;
  ray.origin += enter * ray.direction;
  ray.length = leave - enter;
  return true;
}

}  // namespace

Ball RaySpace::ball() const { return {centre, std::sqrt(3) * half_of_cube / scale}; }

std::optional<Ray> RaySpace::ray(const Vec3& from, const Vec3& to) const {
  const Vec3 start = (from - centre) * scale, end = (to - centre) * scale;
  const Vec3 way = end - start;
  const double length = way.norm();
  if (!(length > 0 && length < std::numeric_limits<double>::infinity())) return std::nullopt;
  const Vec3 direction = way / length;
  Ray ray{start - lengthening * direction, direction, length + 2 * lengthening};
  const bool inside =
      std::max(start.lpNorm<Eigen::Infinity>(), end.lpNorm<Eigen::Infinity>()) <= 1 + lengthening;
  if (!inside && !clip_to_cube(ray)) return std::nullopt;
  return ray;
}

std::optional<Ray> RaySpace::ray_ahead(const Vec3& origin, const Vec3& direction) const {
  const Vec3 start = (origin - centre) * scale - lengthening * direction;
  Ray ray{start, direction, std::numeric_limits<double>::infinity()};
  if (!clip_to_cube(ray)) return std::nullopt;
  return ray;
}

RaySpace make_ray_space(const TriangleSoup& soup, std::span<const int> triangles) {
  RaySpace space;
  Bounds box;
  for (const int t : triangles)
    for (const int v : soup.triangles[at(t)]) box.include(soup.points[at(v)]);
  if (triangles.empty()) return space;
  space.centre = box.centre();
  // The same in all units of length, so that rays meet the same edges: a power of two would let
  // single precision round coordinates by the unit.
  if (const double half = box.half_size().maxCoeff(); half > 0)
    space.scale = largest_coordinate / half;
  space.enlargement = relative_enlargement / space.scale;
  return space;
}

}  // namespace halfshade
