#include "solver/factors/surface_origins.h"

#include <cmath>

namespace halfshade {

RayOrigin SurfaceOrigins::next() {
  constexpr double golden = 0.6180339887498949;
  const std::vector<int>& roots = *roots_;
  double left = (along_ - std::floor(along_)) * area_;
  along_ += golden;
  std::size_t r = 0;
  while (r + 1 < roots.size() && left > scene_->roots.area[at(roots[r])])
    left -= scene_->roots.area[at(roots[r++])];
  const std::uint64_t seed = next_seed_++;
  double u = random_number(seed, 0), v = random_number(seed, 1);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto [p, q, s] = scene_->roots.triangle(roots[r]);
  return {p + u * (q - p) + v * (s - p), scene_->roots.normal[at(roots[r])],
          scene_->cells.before(roots[r])};
}

std::vector<std::vector<int>> roots_of_surfaces(const ReflectingScene& scene,
                                                std::size_t surfaces) {
  std::vector<std::vector<int>> roots(surfaces);
  for (int r = 0; r < scene.roots.count(); ++r) roots[at(scene.roots.surface[at(r)])].push_back(r);
  return roots;
}

}  // namespace halfshade
