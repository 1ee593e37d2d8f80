#include "meshing/arrangement/arrangement.h"
#include "meshing/arrangement/cocircular.h"
#include "meshing/core/error.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>

namespace halfshade {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

// Predicates multiply up to four lengths; near 1 nothing overflows. A power of two changes no
// digit.
double power_of_two_scale(std::span<const Vec2> points) {
  double largest = 0;
  for (const Vec2& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

std::vector<int> linked_points(std::size_t count, std::span<const std::array<int, 2>> links) {
  std::vector<bool> linked(count, false);
  for (const auto& link : links)
    for (const int p : link) linked[static_cast<std::size_t>(p)] = true;
  std::vector<int> result;
  for (std::size_t i = 0; i < count; ++i)
    if (linked[i]) result.push_back(static_cast<int>(i));
  return result;
}

Triangulation build(std::span<const Vec2> points, std::span<const std::array<int, 2>> links) {
  const double scale = power_of_two_scale(points);
  std::vector<std::pair<Kernel::Point_2, int>> sites;
  for (const int i : linked_points(points.size(), links)) {
    const Vec2 p = scale * points[static_cast<std::size_t>(i)];
    sites.emplace_back(Kernel::Point_2(p.x(), p.y()), i);
  }
  Triangulation triangulation;
  triangulation.insert(sites.begin(), sites.end());
  std::vector<Triangulation::Vertex_handle> handle(points.size());
  for (const auto v : triangulation.finite_vertex_handles())
    handle[static_cast<std::size_t>(v->info())] = v;
  for (const auto& [a, b] : links)
    triangulation.insert_constraint(handle[static_cast<std::size_t>(a)],
                                    handle[static_cast<std::size_t>(b)]);
  return triangulation;
}

}  // namespace

HullTriangulation constrained_delaunay(std::span<const Vec2> points,
                                       std::span<const std::array<int, 2>> links) {
  try {
    Triangulation triangulation = build(points, links);
    HullTriangulation result;
    std::vector<std::array<bool, 3>> constrained;
    for (const auto f : triangulation.all_face_handles()) f->info() = -1;
    int count = 0;
    for (const auto f : triangulation.finite_face_handles()) f->info() = count++;
    for (const auto f : triangulation.finite_face_handles()) {
      result.triangles.push_back(
          {f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
      // Here edge k runs from corner k; there it lies opposite corner k.
      result.neighbours.push_back(
          {f->neighbor(2)->info(), f->neighbor(0)->info(), f->neighbor(1)->info()});
      constrained.push_back({f->is_constrained(2), f->is_constrained(0), f->is_constrained(1)});
    }
    settle_ties(points, constrained, result);
    return result;
  } catch (const std::exception& failure) {
    throw Error(ErrorCode::invalid_input, {},
                std::string("the boundary lines could not be triangulated: ") + failure.what());
  }
}

}  // namespace halfshade
