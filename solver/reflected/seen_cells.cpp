#include "solver/reflected/seen_cells.h"

#include "meshing/core/parallel.h"
#include "solver/exchange/shells.h"
#include "solver/reflected/hemisphere_rays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

constexpr double rays_in_all = 1 << 18;
constexpr int strata_at_least = 2, strata_at_most = 8;
/// Of what leaves a cell; and so many rays.
constexpr double clear_share = 0.01;
constexpr int clear_number = 3;

struct Passage {
  int rays = 0;
  double area = 0;  ///< that the rays stand for: splinters look anywhere
};
/// Cells → what gets from the first to the second.
using RaysBetween = std::map<std::pair<int, int>, Passage>;

RaysBetween rays_between_cells(const ReflectingScene& scene) {
  const int count = scene.roots.count();
  const int strata =
      std::clamp(static_cast<int>(std::sqrt(rays_in_all / count)), strata_at_least, strata_at_most);
  std::vector<std::vector<int>> seen(at(count));  // root → cells in which its rays end
  parallel_for(at(count), [&](std::size_t r) {
    const auto [a, b, c] = scene.roots.triangle(static_cast<int>(r));
    const RayHemisphere above{{(a + b + c) / 3, scene.roots.normal[r]}, strata, r};
    for (const RayEnd& end : trace_hemispheres(scene, {&above, 1}).ends)
      seen[r].push_back(scene.cells.before(end.triangle));
  });
  RaysBetween between;
  for (int r = 0; r < count; ++r)
    for (const int cell : seen[at(r)]) {
      Passage& passage = between[{scene.cells.before(r), cell}];
      ++passage.rays;
      passage.area += scene.roots.area[at(r)];
    }
  return between;
}

/// Cell → number of the one that it is a part of.
std::vector<int> joined(const RaysBetween& between, int count) {
  std::vector<double> from(at(count), 0);
  for (const auto& [cells, passage] : between) from[at(cells.first)] += passage.area;
  JoinedSets sets(count);
  for (const auto& [cells, passage] : between)
    if (passage.rays >= clear_number && passage.area > clear_share * from[at(cells.first)])
      sets.join(cells.first, cells.second);
  return sets.numbered();
}

}  // namespace

void join_seen_cells(ReflectingScene& scene) {
  SpaceCells& cells = scene.cells;
  std::set<int> looked_into;
  for (const auto& [front, back] : cells.of_side) looked_into.insert(front);
  if (looked_into.size() < 2) return;
  const std::vector<int> of = joined(rays_between_cells(scene), cells.count());
  const int count = 1 + *std::max_element(of.begin(), of.end());
  if (count == cells.count()) return;
  SpaceCells whole;
  whole.closed.assign(at(count), true);
  whole.gaps.assign(at(count), 0);
  whole.swallowing.assign(at(count), -1);
  whole.outside = of[at(cells.outside)];
  for (std::size_t k = 0; k < of.size(); ++k) {
    const std::size_t cell = at(of[k]);
    whole.closed[cell] = whole.closed[cell] && cells.closed[k];
    whole.gaps[cell] += cells.gaps[k];
    if (whole.swallowing[cell] < 0) whole.swallowing[cell] = cells.swallowing[k];
  }
  for (const auto& [front, back] : cells.of_side)
    whole.of_side.push_back({of[at(front)], of[at(back)]});
  cells = std::move(whole);
}

}  // namespace halfshade
