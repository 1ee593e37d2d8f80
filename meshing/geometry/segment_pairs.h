#pragma once

#include "meshing/core/planar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace halfshade {

struct PairSegment {
  Vec2 a, b;
  bool fresh = true;
};
struct PairPoint {
  Vec2 p;
  bool fresh = true;
};

/// Calls `visit` for all pairs of items that may come within `reach` of each other and of which one
/// at least is fresh: segments with segments, or, if there are points, segments with points. Pairs
/// may come more than once, and pairs farther apart, too. Bisects the plane as long as that saves
/// work, so that long slanted segments cost what they pass through, not what their boxes hold.
template <class Visit>
class SegmentPairs {
 public:
  SegmentPairs(std::span<const PairSegment> segments, std::span<const PairPoint> points,
               double reach, const Visit& visit)
      : segments_(segments), points_(points), reach_(reach), visit_(visit) {}

  void run() {
    std::vector<int> segments(segments_.size()), points(points_.size());
    Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      segments[i] = static_cast<int>(i);
      low = low.cwiseMin(segments_[i].a).cwiseMin(segments_[i].b);
      high = high.cwiseMax(segments_[i].a).cwiseMax(segments_[i].b);
    }
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<int>(i);
    if (!segments.empty()) bisect({low, high}, segments, points, 1);
  }

 private:
  using Items = std::vector<int>;
  struct Area {
    Vec2 low, high;
  };
  static constexpr std::size_t few = 64;  // pairs, which are quicker tried than parted
  static constexpr double futile = 4;     // work may grow by this much before parting ends
  // Nothing that is as near as reach_ may be missed by rounding.
  static constexpr double rounding = 1e-9, margin = 1.01;

  const PairSegment& segment(int i) const { return segments_[static_cast<std::size_t>(i)]; }
  const PairPoint& point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  bool reaches(const PairSegment& s, const Vec2& centre, const Vec2& half) const {
    const Vec2 a = s.a - centre, b = s.b - centre, d = b - a;
    if (std::min(a.x(), b.x()) > half.x() || std::max(a.x(), b.x()) < -half.x() ||
        std::min(a.y(), b.y()) > half.y() || std::max(a.y(), b.y()) < -half.y())
      return false;
    const double off = std::abs(cross_2d(d, a));
    return off <= (std::abs(d.x()) * half.y() + std::abs(d.y()) * half.x()) * (1 + rounding);
  }

  std::size_t work(const Items& segments, const Items& points) const {
    return points_.empty() ? segments.size() * segments.size() / 2
                           : segments.size() * points.size();
  }

  bool has_fresh(const Items& segments, const Items& points) const {
    return std::any_of(segments.begin(), segments.end(), [&](int i) { return segment(i).fresh; }) ||
           std::any_of(points.begin(), points.end(), [&](int i) { return point(i).fresh; });
  }

  // Whether both ends of n lie farther than reach_ to one side of m.
  bool parts(const PairSegment& m, const PairSegment& n) const {
    const Vec2 d = m.b - m.a, to_a = n.a - m.a, to_b = n.b - m.a;
    const double off_a = cross_2d(d, to_a);
    const double off_b = cross_2d(d, to_b);
    const double least = std::min(off_a * off_a, off_b * off_b);
    return (off_a > 0) == (off_b > 0) && least > reach_ * reach_ * d.squaredNorm();
  }

  bool is_far(const PairSegment& s, const Vec2& p) const {
    const Vec2 d = s.b - s.a, to_p = p - s.a;
    const double off = cross_2d(d, to_p);
    return off * off > margin * reach_ * reach_ * d.squaredNorm();
  }

  void visit_all(const Items& segments, const Items& points) const {
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (const int p : points)
        if ((segment(segments[i]).fresh || point(p).fresh) &&
            !is_far(segment(segments[i]), point(p).p))
          visit_(segments[i], p);
    if (!points_.empty()) return;
    std::vector<PairSegment> here;  // side by side in memory
    for (const int i : segments) here.push_back(segment(i));
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if ((here[i].fresh || here[j].fresh) && !parts(here[i], here[j]) &&
            !parts(here[j], here[i]))
          visit_(segments[j], segments[i]);
  }

  // `growth`: how much the work has grown so far because items lie in both halves.
  void bisect(const Area& area, Items& segments, Items& points, double growth) const {
    const std::size_t all = work(segments, points);
    if (all == 0 || !has_fresh(segments, points)) return;
    const Vec2 size = area.high - area.low;
    if (all <= few || growth > futile || size.maxCoeff() < 2 * reach_) {
      visit_all(segments, points);
      return;
    }
    const int axis = size.x() >= size.y() ? 0 : 1;
    std::array<Area, 2> half = {area, area};
    half[0].high[axis] = half[1].low[axis] = 0.5 * (area.low[axis] + area.high[axis]);
    std::array<Items, 2> in_half, points_in_half;
    std::size_t parts = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec2 centre = 0.5 * (half[k].low + half[k].high);
      const Vec2 reach = (0.5 * (half[k].high - half[k].low)).array() + margin * reach_;
      for (const int i : segments)
        if (reaches(segment(i), centre, reach)) in_half[k].push_back(i);
      for (const int i : points)
        if (((point(i).p - centre).cwiseAbs().array() <= reach.array()).all())
          points_in_half[k].push_back(i);
      parts += work(in_half[k], points_in_half[k]);
    }
    Items().swap(segments);
    Items().swap(points);
    const double grown =
        std::max(1.0, growth * static_cast<double>(parts) / static_cast<double>(all));
    for (std::size_t k = 0; k < 2; ++k) bisect(half[k], in_half[k], points_in_half[k], grown);
  }

  std::span<const PairSegment> segments_;
  std::span<const PairPoint> points_;
  double reach_;
  const Visit& visit_;
};

}  // namespace halfshade
