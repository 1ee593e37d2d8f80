#include "solver/reflected/hot_cells.h"

#include "meshing/core/rounded.h"
#include "meshing/geometry/flat_tree.h"
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
constexpr int most_groups = 256;

/// Which way along which axis it points most.
int main_look(const Vec3& normal) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (rounded(std::abs(normal[k])) > rounded(std::abs(normal[axis]))) axis = k;
  return 2 * axis + (normal[axis] > 0 ? 1 : 0);
}

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
  std::vector<double> of_each;
  for (int r = 0; r < roots.count(); ++r)
    for (int c = cells_.first(r); c < cells_.first(r + 1); ++c) {
      const double light = cells_.mean(c).sum();
      if (!(light > hot * power / area)) continue;
      of_each.push_back(area_of(r) * light);
      of_hot += of_each.back();
      hot_.push_back({r, c, cells_.corners(r, c)});
    }
  if (!(of_hot > least_power * power)) {
    hot_.clear();
    return;
  }
  for (double& share : of_each) share /= of_hot;
  make_groups(scene, of_each);
}

void HotCells::make_groups(const ReflectingScene& scene, const std::vector<double>& power) {
  const std::vector<Cell> cells = std::exchange(hot_, {});
  const int most_in_group = std::max(1, static_cast<int>(cells.size()) / most_groups);
  group_.assign(at(cells_.first(scene.roots.count())), -1);
  density_.assign(group_.size(), 0);
  std::array<std::vector<int>, 6> by_look;
  for (std::size_t k = 0; k < cells.size(); ++k)
    by_look[at(main_look(scene.roots.normal[at(cells[k].root)]))].push_back(static_cast<int>(k));
  for (const std::vector<int>& some : by_look) {
    std::vector<Bounds> centres(some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto& [root, number, corners] = cells[at(some[i])];
      centres[i].include(
          position(scene.roots.triangle(root), (corners[0] + corners[1] + corners[2]) / 3));
    }
    const FlatTree tree = make_flat_tree(centres, most_in_group);
    for (const FlatTree::Node& node : tree.nodes) {
      if (node.right >= 0) continue;
      Group group{static_cast<int>(hot_.size()), 0, Vec3::Zero(), Vec3::Zero(), 0, 0};
      for (const int i : std::span(tree.items).subspan(at(node.first), at(node.count))) {
        const std::size_t k = at(some[at(i)]);
        const auto& [root, number, corners] = cells[k];
        const double area =
            scene.roots.area[at(root)] / (cells_.first(root + 1) - cells_.first(root));
        group.centre += power[k] * centres[at(i)].low;
        group.normal += power[k] * scene.roots.normal[at(root)];
        group.area += area;
        group.power += power[k];
        group_[at(number)] = static_cast<int>(groups_.size());
        density_[at(number)] = power[k] / area;
        hot_.push_back(cells[k]);
        up_to_.push_back((up_to_.empty() ? 0 : up_to_.back()) + power[k]);
      }
      group.last = static_cast<int>(hot_.size());
      group.centre /= group.power;
      group.normal /= group.power;
      groups_.push_back(group);
    }
  }
}

HotCells::Aim HotCells::aim_from(std::span<const RayHemisphere> hemispheres) const {
  Vec3 middle = Vec3::Zero();
  for (const RayHemisphere& h : hemispheres)
    middle += h.from.position / static_cast<double>(hemispheres.size());
  double spread = 0;
  for (const RayHemisphere& h : hemispheres)
    spread += (h.from.position - middle).squaredNorm() / static_cast<double>(hemispheres.size());
  const Vec3& normal = hemispheres[0].from.normal;
  Aim aim;
  aim.gain.resize(groups_.size());
  double all = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const Vec3 d = group.centre - middle;
    const double here = normal.dot(d), there = -group.normal.dot(d);
    if (!(here > 0 && there > 0)) continue;
    const double square = d.squaredNorm() + spread + group.area;
    aim.gain[g] = here * there / (square * square);
    all += group.power * aim.gain[g];
  }
  if (!(all > 0)) return {};
  aim.up_to.resize(groups_.size());
  double sum = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (aim.gain[g] > 0) sum += groups_[g].power * (aim.gain[g] /= all);
    aim.up_to[g] = sum;
  }
  return aim;
}

const HotCells::Cell& HotCells::cell_at(const Aim& aim, double share) const {
  const auto end = aim.up_to.end();
  auto found = std::upper_bound(aim.up_to.begin(), end, share);
  if (found == end) found = std::lower_bound(aim.up_to.begin(), end, aim.up_to.back());
  const Group& group = groups_[static_cast<std::size_t>(found - aim.up_to.begin())];
  const double before = found == aim.up_to.begin() ? 0 : *(found - 1);
  const double power_before = group.first > 0 ? up_to_[at(group.first - 1)] : 0;
  const double wanted = power_before + (share - before) / (*found - before) * group.power;
  const auto first = up_to_.begin() + group.first, last = up_to_.begin() + group.last - 1;
  return hot_[static_cast<std::size_t>(std::upper_bound(first, last, wanted) - up_to_.begin())];
}

int HotCells::count(int rays) const {
  return hot_.empty() ? 0 : static_cast<int>(std::ceil(share_of_aimed * rays));
}

double HotCells::expected(const ReflectingScene& scene, const RayOrigin& from, int root,
                          const Vec3& d, double density) const {
  const double here = from.normal.dot(d), there = -scene.roots.normal[at(root)].dot(d);
  const double square = d.squaredNorm();
  if (!(here > 0 && there > 0)) return -1;
  return density * std::numbers::pi * square * square / (here * there);
}

Rgb HotCells::look(const Leaving& leaving, Looks looks, int root, int cell, const Vec3& position,
                   double square_distance) const {
  return looks == Looks::quick && cells_.is_far(root, square_distance) ? cells_.mean(cell)
                                                                       : leaving(root, position);
}

Rgb HotCells::by_all_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                          const RayHemisphere& hemisphere, const Aim& aim,
                          std::span<const RayEnd> ends, int rays) const {
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
    const double dense = density(aim, cell);
    const double other = dense > 0 ? std::max(expected(scene, from, root, d, dense), 0.) : 0;
    sum += look(leaving, looks, root, cell, to, d.squaredNorm()) / (1 + aimed * other / all);
  }
  return sum / rays;
}

void HotCells::add_aimed_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                              std::span<const RayHemisphere> hemispheres, const Aim& aim,
                              ChannelArray& irradiance) const {
  if (aim.up_to.empty()) return;
  std::vector<Segment> segments;
  std::vector<std::pair<Eigen::Index, Rgb>> light;  // what they bring if nothing is in the way
  const auto add_segment = [&](std::size_t h, int k, int aimed) {
    const auto& [from, strata, seed] = hemispheres[h];
    const std::uint64_t own = mix_bits(seed ^ 0x5bd1e995), n = 3 * static_cast<std::uint64_t>(k);
    const auto& [root, cell, corners] = cell_at(aim, (k + random_number(own, n)) / aimed);
    if (from.cell >= 0 && scene.cells.before(root) != from.cell) return;
    const TrianglePlace place =
        place_in(corners, random_number(own, n + 1), random_number(own, n + 2));
    const Vec3 to = position(scene.roots.triangle(root), place), d = to - from.position;
    const double other = expected(scene, from, root, d, density(aim, cell));
    if (other < 0) return;
    segments.push_back({from.position, to, from.plane, scene.visibility.soup().plane[at(root)]});
    light.emplace_back(
        static_cast<Eigen::Index>(h),
        look(leaving, looks, root, cell, to, d.squaredNorm()) / (strata * strata + aimed * other));
  };
  // Those to about the same cells follow each other: they are quicker to trace.
  const int aimed = count(hemispheres[0].strata * hemispheres[0].strata);
  for (int k = 0; k < aimed; ++k)
    for (std::size_t h = 0; h < hemispheres.size(); ++h) add_segment(h, k, aimed);
  std::vector<std::uint8_t> blocked(segments.size());
  scene.visibility.blocked(segments, blocked);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (blocked[i] == 0) irradiance.row(light[i].first) += light[i].second.transpose();
}

ChannelArray HotCells::irradiance(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                                  std::span<const RayHemisphere> hemispheres,
                                  const TracedHemispheres& traced) const {
  ChannelArray result(static_cast<Eigen::Index>(hemispheres.size()), 3);
  const Aim aim = hot_.empty() ? Aim{} : aim_from(hemispheres);
  for (std::size_t h = 0; h < hemispheres.size(); ++h)
    result.row(static_cast<Eigen::Index>(h)) =
        by_all_rays(scene, leaving, looks, hemispheres[h], aim, traced.ends_of(h),
                    traced.of_each[h].rays)
            .transpose();
  if (!hot_.empty()) add_aimed_rays(scene, leaving, looks, hemispheres, aim, result);
  return result;
}

}  // namespace halfshade
