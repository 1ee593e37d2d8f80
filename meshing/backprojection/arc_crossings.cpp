#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/shadow_arrangement.h"

#include <algorithm>
#include <cmath>

// The second step of the arrangement: which arcs cross, and in which order along each.

namespace halfshade {
namespace {

/// A view with more crossings than these and these for each of its arcs is crowded, unless so many
/// of some that are tried are seen: cells have as many to look at then, and take four times as long
/// for each.
constexpr std::size_t few_crossings = 200, crossings_an_arc = 4;
constexpr std::size_t tried_crossings = 12, seen_of_tried = 3;

/// Where in [0, 1] the segment from `start` along `along` passes nearest to direction q, measured
/// along the segment. `normal` is that of the segment's plane through the eye.
double along_segment(const Vec3& start, const Vec3& along, const Vec3& normal, const Vec3& q) {
  const double down = normal.dot(along.cross(q));
  if (!(std::abs(down) > 0)) return 0.5;
  return std::clamp(-normal.dot(start.cross(q - start)) / down, 0., 1.);
}

}  // namespace

bool ShadowArrangement::find_crossings(bool unless_crowded) {
  std::size_t most = unless_crowded ? few_crossings + crossings_an_arc * arcs_.size() : SIZE_MAX;
  crossings_.clear();
  sweep_.resize(arcs_.size());
  for (std::size_t i = 0; i < sweep_.size(); ++i) sweep_[i] = static_cast<int>(i);
  std::sort(sweep_.begin(), sweep_.end(), [&](int a, int b) {
    const double x = arcs_[at(a)].low.x(), y = arcs_[at(b)].low.x();
    return x != y ? x < y : a < b;
  });
  active_.clear();
  for (const int i : sweep_) {
    const Arc& arc = arcs_[at(i)];
    std::size_t kept = 0;
    for (const int j : active_) {
      const Arc& other = arcs_[at(j)];
      if (other.high.x() < arc.low.x()) continue;
      active_[kept++] = j;
      if (other.high.y() < arc.low.y() || other.low.y() > arc.high.y()) continue;
      if (!(arc.is_outline && other.is_outline)) cross(std::min(i, j), std::max(i, j));
    }
    active_.resize(kept);
    active_.push_back(i);
    if (crossings_.size() <= most) continue;
    if (!is_much_seen()) return false;
    most = SIZE_MAX;
  }
  return true;
}

/// Whether no face lies over many of the crossings found so far, as some of them tell.
bool ShadowArrangement::is_much_seen() const {
  std::size_t seen = 0;
  for (std::size_t k = 0; k < tried_crossings && seen < seen_of_tried; ++k) {
    const Crossing& crossing = crossings_[k * crossings_.size() / tried_crossings];
    const Vec3 there = position(arcs_[at(crossing.arc[0])], crossing.along[0]);
    if (view_->clear_sight(there - view_->point()) != ClearSight::hidden) ++seen;
  }
  return seen == seen_of_tried;
}

bool ShadowArrangement::cross(int i, int j) {
  const Arc &a = arcs_[at(i)], &b = arcs_[at(j)];
  if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) return false;
  const int b_from = view_->turn(a.from, a.to, b.from);
  const int b_to = view_->turn(a.from, a.to, b.to);
  if (b_from == b_to) return false;
  const int a_from = view_->turn(b.from, b.to, a.from);
  if (a_from != b_to || view_->turn(b.from, b.to, a.to) == a_from) return false;
  Crossing crossing{
      {i, j}, {}, {a_from < 0 ? b.weight : -b.weight, b_from < 0 ? a.weight : -a.weight}};
  locate_crossing(crossing);
  crossings_.push_back(crossing);
  return true;
}

void ShadowArrangement::locate_crossing(Crossing& crossing) const {
  std::array<Vec3, 2> start, along, normal;
  for (std::size_t k = 0; k < 2; ++k) {
    const Arc& arc = arcs_[at(crossing.arc[k])];
    start[k] = view_->corners[at(arc.from)].direction;
    along[k] = view_->corners[at(arc.to)].position - view_->corners[at(arc.from)].position;
    normal[k] = start[k].cross(along[k]);
  }
  // On each arc, the distances of its ends from the other's plane.
  std::array<double, 2> first{}, drop{};
  bool is_clear = true;
  for (std::size_t k = 0; k < 2; ++k) {
    first[k] = normal[1 - k].dot(start[k] - start[1 - k]);
    drop[k] = -normal[1 - k].dot(along[k]);
    crossing.along[k] = std::clamp(first[k] / drop[k], 0., 1.);
    is_clear = is_clear &&
               std::abs(drop[k]) > margins::near_parallel * normal[1 - k].norm() * along[k].norm();
  }
  if (is_clear) return;
  // Nearly one line: the middle of the common part will do where rounding hides the crossing.
  const Vec3& farther = start[0].squaredNorm() > start[1].squaredNorm() ? start[0] : start[1];
  const double noise =
      margins::same_line * view_->slack_at(view_->point() + farther) * normal[1].norm();
  double t = 0;
  if (std::abs(first[0]) <= noise && std::abs(first[0] - drop[0]) <= noise) {
    const double from = along_segment(start[0], along[0], normal[0], start[1]);
    const double to = along_segment(start[0], along[0], normal[0], start[1] + along[1]);
    t = 0.5 * (from + to);
  } else {
    t = std::clamp(first[0] / drop[0], 0., 1.);
  }
  // Rounding may put it beyond an end of the other one: both are to point one way, for a gap
  // between them would be missing from the boundary.
  crossing.along[1] = along_segment(start[1], along[1], normal[1], start[0] + t * along[0]);
  const Vec3 on_other = start[1] + crossing.along[1] * along[1];
  crossing.along[0] = along_segment(start[0], along[0], normal[0], on_other);
}

void ShadowArrangement::sort_crossings() {
  for (Arc& arc : arcs_) arc.count = 0;
  for (const Crossing& crossing : crossings_)
    for (const int arc : crossing.arc) ++arcs_[at(arc)].count;
  int total = 0;
  for (Arc& arc : arcs_) {
    arc.first = total;
    total += arc.count;
    arc.count = 0;
  }
  order_.resize(at(total));
  for (std::size_t c = 0; c < crossings_.size(); ++c)
    for (const int i : crossings_[c].arc) {
      Arc& arc = arcs_[at(i)];
      order_[at(arc.first + arc.count++)] = static_cast<int>(c);
    }
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const int arc = static_cast<int>(i);
    const auto begin = order_.begin() + arcs_[i].first, end = begin + arcs_[i].count;
    const auto along = [&](int c) {
      const Crossing& crossing = crossings_[at(c)];
      return crossing.along[at(side_of(crossing, arc))];
    };
    std::sort(begin, end,
              [&](int a, int b) { return along(a) != along(b) ? along(a) < along(b) : a < b; });
    // Insertion, because the order of near ties need not be transitive.
    for (auto next = begin; next != end; ++next)
      for (auto c = next; c != begin && along(*c) - along(c[-1]) < margins::near_tie; --c) {
        if (!is_before(arc, *c, c[-1])) break;
        std::swap(*c, c[-1]);
      }
  }
}

/// Whether an arc that meets two others nearly in one point certainly meets `a`'s first: of two
/// arcs that do not cross, one has both its ends on the same side of the other.
bool ShadowArrangement::is_before(int arc, int a, int b) const {
  const Arc& first = arcs_[at(crossings_[at(a)].arc[at(1 - side_of(crossings_[at(a)], arc))])];
  const Arc& second = arcs_[at(crossings_[at(b)].arc[at(1 - side_of(crossings_[at(b)], arc))])];
  const int start = arcs_[at(arc)].from;
  const auto side = [&](const Arc& line, const Arc& other) {
    int sum = 0, ends = 0;
    for (const int end : {other.from, other.to})
      if (end != line.from && end != line.to) {
        sum += view_->turn(line.from, line.to, end);
        ++ends;
      }
    return ends > 0 && std::abs(sum) == ends ? sum : 0;
  };
  if (const int s = side(first, second))
    return (s > 0) != (view_->turn(first.from, first.to, start) > 0);
  if (const int s = side(second, first))
    return (s > 0) == (view_->turn(second.from, second.to, start) > 0);
  return false;
}

}  // namespace halfshade
