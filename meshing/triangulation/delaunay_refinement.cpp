#include "meshing/triangulation/delaunay_refinement.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace halfshade {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Delaunay_mesh_vertex_base_2<Kernel,
                                      CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Mesher = CGAL::Delaunay_mesher_2<Triangulation, Criteria>;
using Link = std::array<int, 2>;

// What a polygon may cost beyond its size: about 0.2 s. Strips up to 1 : 5000 fit in.
constexpr double least_budget = 20000;
// Triangles of a mesh with longest edge h have 0.2 h² or more; its grading may need as many again.
constexpr double triangles_per_squared_length = 40;
constexpr double triangles_per_corner = 64;

Link sorted(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

// The border of the inside, as the links that belong to one triangle only.
std::vector<Link> border_links(const PlanarMesh& mesh) {
  std::vector<Link> all;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) all.push_back(sorted(t[k], t[(k + 1) % 3]));
  std::sort(all.begin(), all.end());
  std::vector<Link> border;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool twice =
        (i > 0 && all[i - 1] == all[i]) || (i + 1 < all.size() && all[i + 1] == all[i]);
    if (!twice) border.push_back(all[i]);
  }
  return border;
}

// Coordinates are scaled by a power of two, which changes no digit, to be near 1.
double scale_of(const PlanarMesh& mesh) {
  double largest = 0;
  for (const Vec2& p : mesh.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

Triangulation insert(const PlanarMesh& mesh, double scale) {
  std::vector<std::pair<Kernel::Point_2, int>> sites;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    sites.emplace_back(Kernel::Point_2(scale * mesh.points[i].x(), scale * mesh.points[i].y()),
                       static_cast<int>(i));
  Triangulation triangulation;
  triangulation.insert(sites.begin(), sites.end());
  std::vector<Triangulation::Vertex_handle> handle(sites.size());
  for (const auto v : triangulation.finite_vertex_handles())
    handle[static_cast<std::size_t>(v->info())] = v;
  for (const auto& [a, b] : mesh.constrained_edges)
    triangulation.insert_constraint(handle[static_cast<std::size_t>(a)],
                                    handle[static_cast<std::size_t>(b)]);
  return triangulation;
}

void mark_inside(Triangulation& triangulation, const std::vector<Link>& border) {
  std::map<Triangulation::Face_handle, bool> inside;
  std::vector<Triangulation::Face_handle> open = {triangulation.infinite_face()};
  inside[open[0]] = false;
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    const bool here = inside[face];
    face->set_in_domain(here);
    for (int k = 0; k < 3; ++k) {
      const auto next = face->neighbor(k);
      if (inside.contains(next)) continue;
      const auto a = face->vertex(Triangulation::ccw(k)), b = face->vertex(Triangulation::cw(k));
      const bool finite = !triangulation.is_infinite(a) && !triangulation.is_infinite(b);
      const bool crosses =
          finite && std::binary_search(border.begin(), border.end(), sorted(a->info(), b->info()));
      inside[next] = here != crosses;
      open.push_back(next);
    }
  }
}

double triangle_budget(const PlanarMesh& coarse, const PlanarMeshOptions& options) {
  double area = 0;
  for (const auto& [a, b, c] : coarse.triangles) {
    const Vec2 &p = coarse.points[static_cast<std::size_t>(a)],
               &q = coarse.points[static_cast<std::size_t>(b)],
               &r = coarse.points[static_cast<std::size_t>(c)];
    area += 0.5 * std::abs((q - p).x() * (r - p).y() - (q - p).y() * (r - p).x());
  }
  double budget = least_budget + triangles_per_corner * static_cast<double>(coarse.points.size());
  if (options.max_length > 0)
    budget += triangles_per_squared_length * (area / options.max_length / options.max_length);
  return std::min(budget, static_cast<double>(options.max_triangles));
}

bool refine(Triangulation& triangulation, const Criteria& criteria, double budget) {
  Mesher mesher(triangulation, criteria);
  mesher.init(true);
  while (!mesher.is_refinement_done()) {
    // A planar triangulation has about two triangles a vertex.
    if (2 * static_cast<double>(triangulation.number_of_vertices()) > budget) return false;
    mesher.step_by_step_refine_mesh();
  }
  return true;
}

PlanarMesh extract(Triangulation& triangulation, const PlanarMesh& coarse, double scale) {
  PlanarMesh mesh;
  mesh.points = coarse.points;
  for (const auto v : triangulation.finite_vertex_handles()) v->info() = -1;
  // Numbered as the triangles come, after the coarse points, which are found by their coordinates.
  std::map<std::pair<double, double>, int> known;
  for (std::size_t i = 0; i < coarse.points.size(); ++i)
    known[{scale * coarse.points[i].x(), scale * coarse.points[i].y()}] = static_cast<int>(i);
  const auto number = [&](const Triangulation::Vertex_handle v) {
    if (v->info() >= 0) return v->info();
    const auto found = known.find({v->point().x(), v->point().y()});
    if (found != known.end()) return v->info() = found->second;
    mesh.points.emplace_back(v->point().x() / scale, v->point().y() / scale);
    return v->info() = static_cast<int>(mesh.points.size()) - 1;
  };
  for (const auto f : triangulation.finite_face_handles()) {
    if (!f->is_in_domain()) continue;
    const std::array<int, 3> t = {number(f->vertex(0)), number(f->vertex(1)), number(f->vertex(2))};
    mesh.triangles.push_back(t);
    for (int k = 0; k < 3; ++k)
      if (f->is_constrained(k))
        mesh.constrained_edges.push_back(sorted(t[static_cast<std::size_t>((k + 1) % 3)],
                                                t[static_cast<std::size_t>((k + 2) % 3)]));
  }
  auto& edges = mesh.constrained_edges;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return mesh;
}

}  // namespace

std::optional<PlanarMesh> delaunay_refinement(const PlanarMesh& coarse,
                                              const PlanarMeshOptions& options) {
  const double sine = std::sin(options.min_angle * std::numbers::pi / 180);
  try {
    const double scale = scale_of(coarse);
    Triangulation triangulation = insert(coarse, scale);
    mark_inside(triangulation, border_links(coarse));
    const Criteria criteria(sine * sine, scale * options.max_length);
    if (!refine(triangulation, criteria, triangle_budget(coarse, options))) return {};
    return extract(triangulation, coarse, scale);
  } catch (const CGAL::Failure_exception&) {
    return {};
  }
}

}  // namespace halfshade
