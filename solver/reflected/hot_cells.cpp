#include "solver/reflected/hot_cells.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/elements/element_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Of the mean; and the least share of all power that leaves.
constexpr double hot = 3, least_power = 0.1;
/// Aimed rays for each of the hemisphere.
constexpr double share_of_aimed = 0.35;

}  // namespace

HotCells::HotCells(const ReflectingScene& scene, const HugeRoots& huge, LeavingCells cells)
    : cells_(std::move(cells)) {
  const ElementTable& roots = scene.roots;
  const auto area_of = [&](int root) {
    return roots.area[at(root)] / (cells_.first(root + 1) - cells_.first(root));
  };
  double area = 0, power = 0, of_hot = 0;
  for (int r = 0; r < roots.count(); ++r) {
    area += huge(r) ? 0 : roots.area[at(r)];
    for (int c = cells_.first(r); c < cells_.first(r + 1); ++c)
      power += area_of(r) * cells_.mean(c).sum();
  }
  density_.assign(at(cells_.first(roots.count())), 0);
  for (int r = 0; r < roots.count(); ++r)
    for (int c = cells_.first(r); c < cells_.first(r + 1); ++c) {
      const double light = cells_.mean(c).sum();
      if (!(light > hot * power / area)) continue;
      of_hot += area_of(r) * light;
      hot_.push_back({r, c, cells_.corners(r, c)});
      up_to_.push_back(of_hot);
      density_[at(c)] = light;
    }
  if (!(of_hot > least_power * power)) {
    hot_.clear();
    up_to_.clear();
    density_.clear();
    return;
  }
  for (double& d : density_) d /= of_hot;
  for (double& share : up_to_) share /= of_hot;
}

int HotCells::count(int rays) const {
  return hot_.empty() ? 0 : static_cast<int>(std::ceil(share_of_aimed * rays));
}

double HotCells::expected(const ReflectingScene& scene, const RayOrigin& from, int root,
                          const Vec3& d, int cell) const {
  const double here = from.normal.dot(d), there = -scene.roots.normal[at(root)].dot(d);
  const double square = d.squaredNorm();
  if (!(here > 0 && there > 0)) return -1;
  return density_[at(cell)] * std::numbers::pi * square * square / (here * there);
}

Rgb HotCells::look(const Leaving& leaving, Looks looks, int root, int cell, const Vec3& position,
                   double square_distance) const {
  return looks == Looks::quick && cells_.is_far(root, square_distance) ? cells_.mean(cell)
                                                                       : leaving(root, position);
}

Rgb HotCells::by_aimed_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                            const RayOrigin& from, int rays, int aimed, std::uint64_t seed) const {
  std::vector<Segment> segments;
  std::vector<Rgb> light;
  std::vector<std::uint8_t> blocked;
  const std::uint64_t own = mix_bits(seed ^ 0x5bd1e995);
  for (int k = 0; k < aimed; ++k) {
    const std::uint64_t n = 3 * static_cast<std::uint64_t>(k);
    const double share = (k + random_number(own, n)) / aimed;
    const std::size_t c =
        std::min(hot_.size() - 1,
                 static_cast<std::size_t>(std::upper_bound(up_to_.begin(), up_to_.end(), share) -
                                          up_to_.begin()));
    const auto& [root, cell, corners] = hot_[c];
    if (from.cell >= 0 && scene.cells.before(root) != from.cell) continue;
    const TrianglePlace place =
        place_in(corners, random_number(own, n + 1), random_number(own, n + 2));
    const Vec3 to = position(scene.roots.triangle(root), place), d = to - from.position;
    const double other = expected(scene, from, root, d, cell);
    if (other < 0) continue;
    segments.push_back({from.position, to, from.plane, scene.visibility.soup().plane[at(root)]});
    light.push_back(look(leaving, looks, root, cell, to, d.squaredNorm()) / (rays + aimed * other));
  }
  blocked.resize(segments.size());
  scene.visibility.blocked(segments, blocked);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (blocked[i] == 0) sum += light[i];
  return sum;
}

Rgb HotCells::irradiance(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                         const RayOrigin& from, int strata, int rays, std::span<const RayEnd> ends,
                         std::uint64_t seed) const {
  const int cast = strata * strata, aimed = count(cast);
  Rgb sum = Rgb::Zero();
  for (const RayEnd& end : ends) {
    const int root = end.triangle;
    const Vec3 to = position(scene.roots.triangle(root), end.place()), d = to - from.position;
    if (cells_.empty()) {
      sum += leaving(root, to);
      continue;
    }
    const int cell = cells_.find(root, end.place());
    const double other = aimed > 0 && density_[at(cell)] > 0
                             ? std::max(expected(scene, from, root, d, cell), 0.)
                             : 0;
    sum += look(leaving, looks, root, cell, to, d.squaredNorm()) / (1 + aimed * other / cast);
  }
  sum /= rays;
  if (aimed > 0) sum += by_aimed_rays(scene, leaving, looks, from, cast, aimed, seed);
  return sum;
}

}  // namespace halfshade
