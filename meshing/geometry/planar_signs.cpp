#include "meshing/geometry/planar_signs.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace halfshade {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_cgal(const Vec2& p) { return {p.x(), p.y()}; }

}  // namespace

int orientation_exactly(const Vec2& a, const Vec2& b, const Vec2& c) {
  return static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c)));
}

int in_circle_exactly(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return static_cast<int>(
      CGAL::side_of_oriented_circle(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

}  // namespace halfshade
