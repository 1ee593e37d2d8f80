#include "meshing/geometry/skew_polygon.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>

namespace halfshade {

std::vector<std::array<int, 3>> triangulate_skew_polygon(std::span<const Vec3> polygon) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Vec3& p : polygon) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
      points, std::back_inserter(found), CGAL::parameters::use_delaunay_triangulation(false));
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : found) triangles.push_back({t.first, t.second, t.third});
  return triangles;
}

}  // namespace halfshade
