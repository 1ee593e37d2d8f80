#include "solver/factors/mutual_sight.h"

#include <cmath>

namespace halfshade {
namespace {

/// What rounding may do to the value, relative to it, beside what quadrature does: contours of
/// distant polygons cancel.
constexpr double rounding = 1e-12;

void add(MutualSight& sum, std::span<const Vec3> p, std::span<const Vec3> q,
         const FormFactorOptions& options, const SightTolerance& tolerance) {
  const MutualArea area = mutual_area(p, q, options);
  sum.value += area.value;
  sum.error += area.error + rounding * std::abs(area.value);
  sum.is_reached = sum.is_reached &&
                   area.error <= std::max(options.floor, tolerance.relative * std::abs(area.value));
}

FormFactorOptions options_of(const SightTolerance& tolerance, std::size_t pairs) {
  FormFactorOptions options;
  options.tolerance = tolerance.relative;
  options.floor = tolerance.absolute / static_cast<double>(pairs);
  return options;
}

}  // namespace

MutualSight clear_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance) {
  const auto &p = scene.surfaces[at(a)].pieces, &q = scene.surfaces[at(b)].pieces;
  const FormFactorOptions options = options_of(tolerance, p.size() * q.size());
  MutualSight sum;
  for (const Polygon3& piece : p)
    for (const Polygon3& other : q) add(sum, piece, other, options, tolerance);
  return sum;
}

MutualSight clear_sight(const SightScene& scene, const Triangle3& part, int b,
                        const SightTolerance& tolerance) {
  const auto& q = scene.surfaces[at(b)].pieces;
  MutualSight sum;
  for (const Polygon3& other : q) add(sum, part, other, options_of(tolerance, q.size()), tolerance);
  return sum;
}

}  // namespace halfshade
