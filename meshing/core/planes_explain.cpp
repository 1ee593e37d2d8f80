#include "meshing/core/planes_explain.h"

#include <cmath>

namespace halfshade {
namespace {

// Planes at less than this angle (the square of its sine) are parallel as far as their normals can
// tell.
constexpr double least_squared_sine = 1e-12;

}  // namespace

bool planes_explain(const Vec3& offset, const Surface& a, const Surface& b) {
  const LocalTolerance tolerance = tolerance_of(a, b);
  if (offset.norm() <= tolerance.length) return true;
  // The offset as a sum of parts along the normals.
  const double cosine = a.frame.normal.dot(b.frame.normal);
  const double along_a = a.frame.normal.dot(offset), along_b = b.frame.normal.dot(offset);
  const double squared_sine = a.frame.normal.cross(b.frame.normal).squaredNorm();
  if (squared_sine <= least_squared_sine) return false;
  return std::abs(along_a - cosine * along_b) <= squared_sine * tolerance.planarity &&
         std::abs(along_b - cosine * along_a) <= squared_sine * tolerance.planarity;
}

}  // namespace halfshade
