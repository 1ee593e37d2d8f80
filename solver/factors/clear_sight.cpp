#include "meshing/core/plane_frame.h"
#include "meshing/geometry/convex_hull.h"
#include "solver/factors/mutual_sight.h"

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// What rounding may do to the value, relative to it, beside what quadrature does: contours of
/// distant polygons cancel.
constexpr double rounding = 1e-12;
/// In area; rounding does not decide which.
constexpr double far_larger = 2;

void add(MutualSight& sum, const MutualArea& area, const FormFactorOptions& options,
         const SightTolerance& tolerance) {
  sum.value += area.value;
  sum.error += area.error + rounding * std::abs(area.value);
  const bool is_reached =
      area.error <= std::max(options.floor, tolerance.relative * std::abs(area.value));
  sum.is_reached = sum.is_reached && is_reached;
  sum.is_at_limit = sum.is_at_limit || (!is_reached && area.points >= options.max_points);
}

FormFactorOptions options_of(const SightTolerance& tolerance, std::size_t pairs) {
  FormFactorOptions options;
  options.tolerance = tolerance.relative;
  options.floor = tolerance.absolute / static_cast<double>(pairs);
  options.max_points = tolerance.max_points;
  return options;
}

/// What is integrated along is the smaller one's contour: what rounding does goes like its length
/// and the distance. Along the larger one's it would be lost in a box of surroundings 1e8 as large.
MutualArea area_between(std::span<const Vec3> p, double p_area, const SightSurface& surface,
                        std::size_t piece, const FormFactorOptions& options,
                        const std::stop_token& stop) {
  const Polygon3& q = surface.pieces[piece];
  const bool is_larger = p_area > far_larger * surface.far_pieces[piece].area;
  return is_larger ? mutual_area(q, p, options, stop) : mutual_area(p, q, options, stop);
}

/// Their hull if they fill it.
std::vector<Polygon3> joined_triangles(const std::vector<Triangle3>& triangles,
                                       const PlaneFrame& frame) {
  std::vector<Polygon3> polygons;
  std::vector<Vec2> corners;
  double area = 0;
  for (const Triangle3& triangle : triangles) {
    polygons.emplace_back(triangle.begin(), triangle.end());
    area += area_vector(triangle).norm();
    for (const Vec3& p : triangle) corners.push_back(frame.to_plane(p));
  }
  Polygon3 hull;
  for (const std::size_t k : convex_hull(corners)) hull.push_back(polygons[k / 3][k % 3]);
  if (area >= (1 - rounding) * area_vector(hull).norm()) return {hull};
  return polygons;
}

}  // namespace

MutualSight clear_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance,
                        const std::stop_token& stop) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  const FormFactorOptions options = options_of(tolerance, p.pieces.size() * q.pieces.size());
  MutualSight sum;
  for (std::size_t k = 0; k < p.pieces.size(); ++k)
    for (std::size_t l = 0; l < q.pieces.size(); ++l) {
      const auto far = far_area(p.far_pieces[k], q.far_pieces[l], options);
      add(sum, far ? *far : area_between(p.pieces[k], p.far_pieces[k].area, q, l, options, stop),
          options, tolerance);
    }
  return sum;
}

MutualSight clear_sight(const SightScene& scene, const Triangle3& part, int b,
                        const SightTolerance& tolerance, const std::stop_token& stop) {
  const SightSurface& q = scene.surfaces[at(b)];
  const double area = area_vector(part).norm();
  const FormFactorOptions options = options_of(tolerance, q.pieces.size());
  MutualSight sum;
  for (std::size_t l = 0; l < q.pieces.size(); ++l)
    add(sum, area_between(part, area, q, l, options, stop), options, tolerance);
  return sum;
}

MutualSight clear_sight_in_cells(const SightScene& scene, int a, int b,
                                 const SightTolerance& tolerance, const std::stop_token& stop) {
  const std::vector<Polygon3> own =
      joined_triangles(facing_triangles(scene, a, b).triangles, scene.surfaces[at(a)].frame);
  const std::vector<Polygon3> other =
      joined_triangles(facing_triangles(scene, b, a).triangles, scene.surfaces[at(b)].frame);
  const FormFactorOptions options = options_of(tolerance, own.size() * other.size());
  MutualSight sum;
  for (const Polygon3& p : own)
    for (const Polygon3& q : other) add(sum, mutual_area(p, q, options, stop), options, tolerance);
  return sum;
}

}  // namespace halfshade
