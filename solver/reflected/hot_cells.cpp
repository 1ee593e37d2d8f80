#include "solver/reflected/hot_cells.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/elements/element_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

Rgb HotCells::by_all_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                          const RayHemisphere& hemisphere, std::span<const RayEnd> ends,
                          int rays) const {
  const RayOrigin& from = hemisphere.from;
  const int all = hemisphere.strata * hemisphere.strata, aimed = count(all);
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
    sum += look(leaving, looks, root, cell, to, d.squaredNorm()) / (1 + aimed * other / all);
  }
  return sum / rays;
}

void HotCells::add_aimed_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                              std::span<const RayHemisphere> hemispheres,
                              ChannelArray& irradiance) const {
  std::vector<Segment> segments;
  std::vector<std::pair<Eigen::Index, Rgb>> light;  // what they bring if nothing is in the way
  using Shares = std::vector<double>::const_iterator;
  const auto add_segment = [&](std::size_t h, int k, int aimed, Shares first, Shares last) {
    const auto& [from, strata, seed] = hemispheres[h];
    const std::uint64_t own = mix_bits(seed ^ 0x5bd1e995), n = 3 * static_cast<std::uint64_t>(k);
    const Shares up_to = std::upper_bound(first, last, (k + random_number(own, n)) / aimed);
    const auto& [root, cell, corners] =
        hot_[std::min(hot_.size() - 1, static_cast<std::size_t>(up_to - up_to_.begin()))];
    if (from.cell >= 0 && scene.cells.before(root) != from.cell) return;
    const TrianglePlace place =
        place_in(corners, random_number(own, n + 1), random_number(own, n + 2));
    const Vec3 to = position(scene.roots.triangle(root), place), d = to - from.position;
    const double other = expected(scene, from, root, d, cell);
    if (other < 0) return;
    segments.push_back({from.position, to, from.plane, scene.visibility.soup().plane[at(root)]});
    light.emplace_back(
        static_cast<Eigen::Index>(h),
        look(leaving, looks, root, cell, to, d.squaredNorm()) / (strata * strata + aimed * other));
  };
  // Those to about the same cells follow each other: they are quicker to trace.
  const int aimed = count(hemispheres[0].strata * hemispheres[0].strata);
  Shares first = up_to_.begin();
  for (int k = 0; k < aimed; ++k) {
    const Shares last = std::upper_bound(first, up_to_.end(), (k + 1.) / aimed);
    for (std::size_t h = 0; h < hemispheres.size(); ++h) add_segment(h, k, aimed, first, last);
    first = last;
  }
  std::vector<std::uint8_t> blocked(segments.size());
  scene.visibility.blocked(segments, blocked);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (blocked[i] == 0) irradiance.row(light[i].first) += light[i].second.transpose();
}

ChannelArray HotCells::irradiance(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                                  std::span<const RayHemisphere> hemispheres,
                                  const TracedHemispheres& traced) const {
  ChannelArray result(static_cast<Eigen::Index>(hemispheres.size()), 3);
  for (std::size_t h = 0; h < hemispheres.size(); ++h)
    result.row(static_cast<Eigen::Index>(h)) =
        by_all_rays(scene, leaving, looks, hemispheres[h], traced.ends_of(h),
                    traced.of_each[h].rays)
            .transpose();
  if (!hot_.empty()) add_aimed_rays(scene, leaving, looks, hemispheres, result);
  return result;
}

}  // namespace halfshade
