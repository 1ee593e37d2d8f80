#include "meshing/patches/shared_lines.h"

#include "meshing/core/planes_explain.h"
#include "meshing/geometry/flat_tree.h"
#include "meshing/patches/margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

struct Stretch {
  Vec3 from, to;
  double reach = 0;  // how far off another may lie to be the same

  double length() const { return (to - from).norm(); }
};

Stretch stretch(const Surface& surface, const Segment2& ends, double shortest) {
  const LocalTolerance tolerance = tolerance_of(surface);
  return {surface.frame.to_space(ends[0]), surface.frame.to_space(ends[1]),
          std::max(tolerance.length,
                   std::min(2 * tolerance.planarity, margins::largest_gap * shortest))};
}

void collect(const SoundScene& scene, SharedLines& out, std::vector<Stretch>& stretches) {
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const Surface& surface = scene.surfaces[r];
    out.first_border.push_back(static_cast<int>(out.borders.size()));
    const auto add = [&](const Segment2& ends, double shortest) {
      out.borders.push_back({static_cast<int>(r), ends});
      stretches.push_back(stretch(surface, ends, shortest));
    };
    for (const Ring& ring : surface.rings) {
      const std::size_t n = ring.size();
      const auto length = [&](std::size_t k) { return (ring[(k + 1) % n] - ring[k % n]).norm(); };
      for (std::size_t k = 0; k < n; ++k)
        add({ring[k], ring[(k + 1) % n]}, std::min({length(k + n - 1), length(k), length(k + 1)}));
    }
    for (const Segment2& contact : surface.contacts) add(contact, (contact[1] - contact[0]).norm());
  }
  out.first_border.push_back(static_cast<int>(out.borders.size()));
}

struct Overlap {
  double gap;
  int first, second;
  auto operator<=>(const Overlap&) const = default;
};

// Joins borders that lie on each other, the closest first.
class BorderJoiner {
 public:
  BorderJoiner(const SoundScene& scene, const SharedLines& lines,
               const std::vector<Stretch>& stretches)
      : scene_(scene), lines_(lines), stretches_(stretches), group_(stretches.size()) {
    std::iota(group_.begin(), group_.end(), 0);
    for (int w = 0; w < static_cast<int>(stretches.size()); ++w) members_.push_back({w});
  }

  // The groups, each sorted; some are empty.
  std::vector<std::vector<int>> run() {
    std::vector<Overlap> overlaps = find_overlaps();
    std::sort(overlaps.begin(), overlaps.end());
    for (const auto& [gap, i, j] : overlaps) {
      const auto a = at(std::min(group_[at(i)], group_[at(j)]));
      const auto b = at(std::max(group_[at(i)], group_[at(j)]));
      if (a == b || clash(members_[a], members_[b])) continue;
      const auto middle = static_cast<std::ptrdiff_t>(members_[a].size());
      members_[a].insert(members_[a].end(), members_[b].begin(), members_[b].end());
      std::inplace_merge(members_[a].begin(), members_[a].begin() + middle, members_[a].end());
      for (const int w : members_[b]) group_[at(w)] = static_cast<int>(a);
      members_[b].clear();
    }
    return std::move(members_);
  }

 private:
  const Surface& surface(int border) const {
    return scene_.surfaces[at(lines_.borders[at(border)].surface)];
  }

  std::vector<Overlap> find_overlaps() const {
    std::vector<Bounds> boxes;
    for (const Stretch& s : stretches_) boxes.push_back(bounds_of(s.from, s.to).grown(s.reach));
    const FlatTree tree = make_flat_tree(boxes, 1);
    std::vector<Overlap> overlaps;
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
      visit_overlaps(tree, boxes[at(i)], [&](int j) {
        if (j >= i || lines_.borders[at(i)].surface == lines_.borders[at(j)].surface) return;
        const bool j_is_longer = stretches_[at(i)].length() < stretches_[at(j)].length();
        const double gap = j_is_longer ? gap_between(j, i) : gap_between(i, j);
        if (gap < HUGE_VAL) overlaps.push_back({gap, j, i});
      });
    return overlaps;
  }

  // Where the second runs along the first, in terms of the first's length.
  std::array<double, 2> range_along(int first, int second) const {
    const Stretch &a = stretches_[at(first)], &b = stretches_[at(second)];
    const Vec3 direction = (a.to - a.from) / a.length();
    return {direction.dot(b.from - a.from), direction.dot(b.to - a.from)};
  }

  // Infinite if they do not lie on each other. The first is not shorter than the second.
  double gap_between(int first, int second) const {
    const Stretch &a = stretches_[at(first)], &b = stretches_[at(second)];
    if (!(b.length() > 0)) return HUGE_VAL;
    const auto [t0, t1] = range_along(first, second);
    const double begin = std::max(std::min(t0, t1), 0.0);
    const double end = std::min(std::max(t0, t1), a.length());
    if (!(end > begin)) return HUGE_VAL;
    const auto offset = [&](double t) -> Vec3 {
      return b.from + (t - t0) / (t1 - t0) * (b.to - b.from) -
             (a.from + t / a.length() * (a.to - a.from));
    };
    // Most pairs end here, and what follows takes ten times as long.
    const std::array<Vec3, 2> offsets = {offset(begin), offset(end)};
    const double gap = std::max(offsets[0].norm(), offsets[1].norm());
    if (gap > std::min(a.reach, b.reach)) return HUGE_VAL;
    if (!(end - begin > tolerance_of(surface(first), surface(second)).length)) return HUGE_VAL;
    for (const Vec3& o : offsets)
      if (!planes_explain(o, surface(first), surface(second))) return HUGE_VAL;
    // Or they only touch at their ends, which overlap by as much as planes are off.
    return gap <= margins::largest_gap * (end - begin) ? gap : HUGE_VAL;
  }

  // Whether borders of one surface would come to lie on each other.
  bool clash(const std::vector<int>& a, const std::vector<int>& b) const {
    const auto& [fewer, more] =
        std::minmax(a, b, [](auto& x, auto& y) { return x.size() < y.size(); });
    for (const int w : fewer) {
      const int r = lines_.borders[at(w)].surface;
      auto other = std::lower_bound(more.begin(), more.end(), lines_.first_border[at(r)]);
      for (; other != more.end() && *other < lines_.first_border[at(r) + 1]; ++other) {
        const auto [t0, t1] = range_along(w, *other);
        if (std::min(std::max(t0, t1), stretches_[at(w)].length()) -
                std::max(std::min(t0, t1), 0.0) >
            tolerance_of(surface(w)).length)
          return true;
      }
    }
    return false;
  }

  const SoundScene& scene_;
  const SharedLines& lines_;
  const std::vector<Stretch>& stretches_;
  std::vector<int> group_;                 // of each border
  std::vector<std::vector<int>> members_;  // of each group, sorted
};

}  // namespace

SharedLines find_shared_lines(const SoundScene& scene) {
  SharedLines result;
  std::vector<Stretch> stretches;
  collect(scene, result, stretches);
  std::vector<std::vector<int>> groups = BorderJoiner(scene, result, stretches).run();
  for (std::vector<int>& borders : groups) {
    if (borders.size() < 2) continue;
    const auto& longest =
        stretches[at(*std::max_element(borders.begin(), borders.end(), [&](int a, int b) {
          return stretches[at(a)].length() < stretches[at(b)].length();
        }))];
    SharedLine line;
    line.origin = longest.from;
    line.direction = (longest.to - longest.from) / longest.length();
    double begin = HUGE_VAL, end = -HUGE_VAL;
    LocalScale scale = scene.surfaces[at(result.borders[at(borders[0])].surface)].scale;
    for (const int w : borders) {
      BorderLine& border = result.borders[at(w)];
      const PlaneFrame& frame = scene.surfaces[at(border.surface)].frame;
      scale = joint_scale(scale, scene.surfaces[at(border.surface)].scale);
      border.line = static_cast<int>(result.lines.size());
      border.begin = along(line, frame, border.ends[0]);
      border.end = along(line, frame, border.ends[1]);
      begin = std::min({begin, border.begin, border.end});
      end = std::max({end, border.begin, border.end});
      for (const Vec3& p : {stretches[at(w)].from, stretches[at(w)].to})
        line.gap = std::max(line.gap, line.direction.cross(p - line.origin).norm());
    }
    line.length = tolerance_of(scale).length;
    line.extent = end - begin;
    line.borders = std::move(borders);
    result.lines.push_back(std::move(line));
  }
  return result;
}

double along(const SharedLine& line, const PlaneFrame& frame, const Vec2& point) {
  // Not by way of the point in space, which loses digits far from the origin.
  return line.direction.dot(frame.origin - line.origin) + point.x() * line.direction.dot(frame.e1) +
         point.y() * line.direction.dot(frame.e2);
}

}  // namespace halfshade
