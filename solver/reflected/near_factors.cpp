#include "solver/reflected/near_factors.h"

#include "solver/exchange/form_factor.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Gaps up to this share of an element's size are near.
constexpr double nearest = 0.5;
constexpr double factor_tolerance = 1e-7;
/// Elements as long as this many gaps have nodes where light gets lost.
constexpr double seen_gaps = 3;
constexpr double least_gap = 1e-9;  // of an element's size

Vec3 normal_of(const std::array<Vec3, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

/// The height of the lowest corner above a plane, or −1 if the triangle does not lie near before
/// it.
double gap(const std::array<Vec3, 3>& corners, double size, const PlaneFrame& plane) {
  if (!(plane.normal.dot(normal_of(corners)) < 0)) return -1;
  const auto [low, high] =
      std::minmax({plane.height(corners[0]), plane.height(corners[1]), plane.height(corners[2])});
  return high < nearest * size ? low : -1;
}

}  // namespace

std::vector<NearFactor> near_factors(const ExactSight& sight, const ReflectedMesh& mesh,
                                     int element, std::span<const Sighted> targets) {
  const std::array<Vec3, 3>& corners = mesh.forest.corners(mesh.triangle[at(element)]);
  const double area = mesh.area(element);
  FormFactorOptions options;
  options.tolerance = factor_tolerance;
  options.floor = factor_tolerance * area;
  std::vector<NearFactor> factors;
  for (const Sighted& target : targets) {
    const PlaneFrame& plane = sight.scene().surfaces[at(target.surface)].frame;
    const double height = gap(corners, std::sqrt(area), plane);
    if (!target.is_clear || height < 0) continue;
    double sum = 0;
    for (const int root : sight.roots(target.surface))
      sum += mutual_area(corners, mesh.forest.corners(root), options).value;
    const double parts =
        std::sqrt(area) / (seen_gaps * std::max(height, least_gap * std::sqrt(area)));
    factors.push_back({target.surface, sum / area, parts});
  }
  return factors;
}

double mean_factor(int surface, const ReflectedMesh& mesh, const ElementTable& roots, int element,
                   std::span<const IrradianceRow> rows) {
  const auto weights = element_nodes_of(mesh.order[at(mesh.triangle[at(element)])]).fit.row(0);
  double mean = 0;
  for (std::size_t n = 0; n < rows.size(); ++n)
    for (std::size_t k = 0; k < rows[n].triangle.size(); ++k)
      if (roots.surface[at(mesh.forest.root(rows[n].triangle[k]))] == surface)
        mean += weights[static_cast<Eigen::Index>(n)] * rows[n].moments[at(rows[n].first[k])];
  return mean;
}

}  // namespace halfshade
