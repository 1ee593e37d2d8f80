#include "solver/factors/exchange_work.h"

#include <map>

namespace halfshade {
namespace {

/// The part of all pairs that something comes between, in rooms full of things and among the facets
/// of a figure.
constexpr double partial_share = 0.25;
constexpr double looks_of_pair = 64;
/// Of a look, and what each polygon that may come between adds to it. Convex bodies add little.
constexpr double look_seconds = 1e-6, seconds_for_polygon = 3e-8;
constexpr double ray_seconds = 1e-6;

/// Pairs of surfaces, one of them with a row, that are in one cell of space.
double pairs_in_cells(const FactorScene& scene, const SightScene& sight) {
  struct Count {
    double with_row = 0, others = 0;
  };
  std::map<int, Count> cells;
  for (std::size_t s = 0; s < sight.surfaces.size(); ++s)
    for (const int cell : sight.surfaces[s].cells)
      (scene.row[s] >= 0 ? cells[cell].with_row : cells[cell].others) += 1;
  double pairs = 0;
  for (const auto& [cell, count] : cells)
    pairs += count.with_row * (count.with_row / 2 + count.others);
  return pairs;
}

}  // namespace

double exact_seconds(const FactorScene& scene, const SightScene& sight) {
  double seconds = look_seconds;
  for (const Blocker& blocker : sight.blockers)
    if (blocker.body < 0) seconds += seconds_for_polygon;
  return partial_share * pairs_in_cells(scene, sight) * looks_of_pair * seconds;
}

std::size_t rays_in(double seconds) { return static_cast<std::size_t>(seconds / ray_seconds); }

}  // namespace halfshade
