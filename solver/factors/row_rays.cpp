#include "solver/factors/row_rays.h"

#include "meshing/geometry/scrambled_sobol.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

/// So many rays go together.
constexpr std::uint32_t rays_together = 4096;

}  // namespace

RowPlaces::RowPlaces(const ReflectingScene& scene, std::vector<int> roots)
    : scene_(&scene), roots_(std::move(roots)) {
  double sum = 0;
  for (const int root : roots_) area_.push_back(sum += scene.roots.area[at(root)]);
}

RayOrigin RowPlaces::at_numbers(double u, double v) const {
  const double along = u * area_.back();
  const auto found = std::upper_bound(area_.begin(), area_.end() - 1, along);
  const auto k = static_cast<std::size_t>(found - area_.begin());
  const double before = k > 0 ? area_[k - 1] : 0;
  // What is left of the first number is as evenly spread in the triangle as it is in all of them.
  const double side = std::sqrt(std::clamp((along - before) / (area_[k] - before), 0., 1.));
  const int root = roots_[k];
  const auto [p, q, r] = scene_->roots.triangle(root);
  return {p + side * (q - p + v * (r - q)), scene_->roots.normal[at(root)],
          scene_->cells.before(root)};
}

std::vector<std::vector<int>> roots_of_rows(const FactorScene& scene,
                                            const ReflectingScene& reflecting) {
  std::vector<std::vector<int>> roots(scene.names.size());
  for (int r = 0; r < reflecting.roots.count(); ++r) {
    const int row = scene.row[at(reflecting.roots.surface[at(r)])];
    if (row >= 0) roots[at(row)].push_back(r);
  }
  return roots;
}

void count_rays(const FactorScene& scene, const ReflectingScene& reflecting, const RowPlaces& from,
                const RowRays& rays, std::span<std::uint32_t> hits) {
  const ScrambledSobol sequence(rays.seed);
  std::vector<RayOrigin> origins;
  std::vector<Vec2> on_square;
  for (std::uint32_t first = rays.first; first < rays.last; first += rays_together) {
    const std::uint32_t last = std::min(rays.last, first + rays_together);
    origins.clear();
    on_square.clear();
    for (std::uint32_t k = first; k < last; ++k) {
      const auto [u, v, x, y] = sequence.point(k);
      origins.push_back(from.at_numbers(u, v));
      on_square.emplace_back(x, y);
    }
    for (const RayEnd& end : trace_rays(reflecting, origins, on_square)) {
      if (end.triangle < 0) continue;
      const int row = scene.row[at(reflecting.roots.surface[at(end.triangle)])];
      ++hits[at(row >= 0 ? row : row == surroundings ? scene.rows() : scene.rows() + 1)];
    }
  }
}

}  // namespace halfshade
