#include "meshing/core/rounded.h"
#include "meshing/discontinuity/stacked_curves.h"
#include "meshing/geometry/collinear.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

/// A straight curve on the common line of its group.
struct Stretch {
  int curve = 0;
  bool reversed = false;
  double low = 0, high = 0;        ///< positions of its ends on the line
  std::size_t begin = 0, end = 0;  ///< numbers of the cuts that these belong to
};

/// Ends of curves within the tolerance of each other, as one point.
struct Cut {
  double position = 0;        ///< of the first
  double longest = -1;        ///< length of the longest curve that ends here
  Vec2 point = Vec2::Zero();  ///< where that one ends
};

class Line {
 public:
  Line(std::span<const DiscontinuityCurve> curves, double tolerance,
       std::vector<MergedCurve>& merged)
      : curves_(curves), tolerance_(tolerance), merged_(merged) {}

  /// Overlays the curves of one line; the first of them sets its direction.
  std::size_t merge(std::span<const int> which) {
    place(which);
    make_cuts();
    // Curves that shrink to a point are not merged.
    const auto shrunk = std::stable_partition(stretches_.begin(), stretches_.end(),
                                              [](const Stretch& s) { return s.begin < s.end; });
    for (auto s = shrunk; s != stretches_.end(); ++s) keep(s->curve);
    stretches_.erase(shrunk, stretches_.end());
    std::stable_sort(stretches_.begin(), stretches_.end(),
                     [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
    std::size_t count = 0;
    for (std::size_t first = 0; first < stretches_.size();) {
      std::size_t last = first + 1, end = stretches_[first].end;
      for (; last < stretches_.size() && stretches_[last].begin < end; ++last)
        end = std::max(end, stretches_[last].end);
      overlay({stretches_.data() + first, last - first}, end);
      count += last - first - 1;
      first = last;
    }
    return count;
  }

 private:
  const DiscontinuityCurve& curve(int i) const { return curves_[at(i)]; }

  void keep(int i) { merged_.push_back({i, curve(i)}); }

  void place(std::span<const int> which) {
    const ConicArc& base = curve(which.front()).arc;
    const Vec2 along = (base.to - base.from).normalized();
    stretches_.clear();
    for (const int i : which) {
      const double from = along.dot(curve(i).arc.from - base.from);
      const double to = along.dot(curve(i).arc.to - base.from);
      stretches_.push_back({i, to < from, std::min(from, to), std::max(from, to)});
    }
  }

  void make_cuts() {
    std::vector<std::pair<double, std::size_t>> ends;  // 2 k: low end of stretch k; 2 k + 1: high
    for (std::size_t k = 0; k < stretches_.size(); ++k) {
      ends.emplace_back(stretches_[k].low, 2 * k);
      ends.emplace_back(stretches_[k].high, 2 * k + 1);
    }
    std::sort(ends.begin(), ends.end());
    cuts_.clear();
    for (const auto& [position, which] : ends) {
      Stretch& stretch = stretches_[which / 2];
      const bool high = which % 2 == 1;
      if (cuts_.empty() || position > cuts_.back().position + tolerance_)
        cuts_.push_back({position});
      (high ? stretch.end : stretch.begin) = cuts_.size() - 1;
      const ConicArc& arc = curve(stretch.curve).arc;
      if (const double length = rounded(stretch.high - stretch.low);
          length > cuts_.back().longest) {
        cuts_.back().longest = length;
        cuts_.back().point = high != stretch.reversed ? arc.to : arc.from;
      }
    }
  }

  /// Merges curves that form one connected stretch, sorted by where they begin.
  void overlay(std::span<Stretch> stretches, std::size_t end) {
    if (stretches.size() == 1) return keep(stretches.front().curve);
    const Stretch* longest = &stretches.front();
    int place = longest->curve;
    for (const Stretch& s : stretches) {
      place = std::min(place, s.curve);
      const auto rank = [](const Stretch& t) {
        return std::pair(rounded(t.low - t.high), t.curve);
      };
      if (rank(s) < rank(*longest)) longest = &s;
    }
    const bool backwards = longest->reversed;
    std::vector<const Stretch*> active;
    std::vector<std::size_t> starts = {stretches.front().begin};  // of the pieces, and the end
    std::vector<DiscontinuityCurve> pieces;
    std::size_t next = 0;
    for (std::size_t c = stretches.front().begin; c < end; ++c) {
      const std::size_t before = active.size(), next_before = next;
      std::erase_if(active, [&](const Stretch* s) { return s->end == c; });
      const bool changed = active.size() < before;
      for (; next < stretches.size() && stretches[next].begin == c; ++next)
        active.push_back(&stretches[next]);
      if (!changed && next == next_before) continue;
      DiscontinuityCurve piece = stack_of(active, backwards);
      if (!pieces.empty() && alike(pieces.back(), piece)) continue;
      if (!pieces.empty()) starts.push_back(c);
      pieces.push_back(std::move(piece));
    }
    starts.push_back(end);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const Vec2 low = cuts_[starts[k]].point, high = cuts_[starts[k + 1]].point;
      pieces[k].arc = backwards ? straight_arc(high, low) : straight_arc(low, high);
      merged_.push_back({place, std::move(pieces[k])});
    }
  }

  DiscontinuityCurve stack_of(std::span<const Stretch* const> active, bool backwards) const {
    std::vector<StackedCurve> members;
    for (const Stretch* s : active) members.push_back({s->curve, s->reversed != backwards});
    std::sort(members.begin(), members.end(),
              [](const StackedCurve& a, const StackedCurve& b) { return a.curve < b.curve; });
    return stack(curves_, members, {});
  }

  std::span<const DiscontinuityCurve> curves_;
  double tolerance_;
  std::vector<MergedCurve>& merged_;
  std::vector<Stretch> stretches_;
  std::vector<Cut> cuts_;
};

}  // namespace

std::size_t merge_straight(std::span<const DiscontinuityCurve> curves, std::span<const int> which,
                           double tolerance, std::vector<MergedCurve>& merged) {
  std::vector<std::array<Vec2, 2>> segments;
  for (const int i : which) {
    const ConicArc& arc = curves[at(i)].arc;
    segments.push_back({arc.from, arc.to});
  }
  const std::vector<int> group = collinear_groups(segments, tolerance);
  const auto group_of = [&](int k) { return group[at(k)]; };
  std::vector<int> order(which.size());
  std::iota(order.begin(), order.end(), 0);
  // The longest curve of a group, after which it is named, first.
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(group_of(a), a != group_of(a)) < std::tuple(group_of(b), b != group_of(b));
  });
  Line line(curves, tolerance, merged);
  std::size_t count = 0;
  std::vector<int> members;
  for (std::size_t k = 0; k < order.size(); ++k) {
    members.push_back(which[at(order[k])]);
    if (k + 1 < order.size() && group_of(order[k]) == group_of(order[k + 1])) continue;
    count += line.merge(members);
    members.clear();
  }
  return count;
}

}  // namespace halfshade
