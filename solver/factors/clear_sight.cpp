#include "solver/factors/mutual_sight.h"

#include <cmath>

namespace halfshade {
namespace {

/// What rounding may do to the value, relative to it, beside what quadrature does: contours of
/// distant polygons cancel.
constexpr double rounding = 1e-12;

void add(MutualSight& sum, const MutualArea& area, const FormFactorOptions& options,
         const SightTolerance& tolerance) {
  sum.value += area.value;
  sum.error += area.error + rounding * std::abs(area.value);
  sum.is_reached = sum.is_reached &&
                   area.error <= std::max(options.floor, tolerance.relative * std::abs(area.value));
}

FormFactorOptions options_of(const SightTolerance& tolerance, std::size_t pairs) {
  FormFactorOptions options;
  options.tolerance = tolerance.relative;
  options.floor = tolerance.absolute / static_cast<double>(pairs);
  options.max_points = tolerance.max_points;
  return options;
}

}  // namespace

MutualSight clear_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  const FormFactorOptions options = options_of(tolerance, p.pieces.size() * q.pieces.size());
  MutualSight sum;
  for (std::size_t k = 0; k < p.pieces.size(); ++k)
    for (std::size_t l = 0; l < q.pieces.size(); ++l) {
      const auto far = far_area(p.far_pieces[k], q.far_pieces[l], options);
      add(sum, far ? *far : mutual_area(p.pieces[k], q.pieces[l], options), options, tolerance);
    }
  return sum;
}

MutualSight clear_sight(const SightScene& scene, const Triangle3& part, int b,
                        const SightTolerance& tolerance) {
  const auto& q = scene.surfaces[at(b)].pieces;
  MutualSight sum;
  for (const Polygon3& other : q) {
    const FormFactorOptions options = options_of(tolerance, q.size());
    add(sum, mutual_area(part, other, options), options, tolerance);
  }
  return sum;
}

}  // namespace halfshade
