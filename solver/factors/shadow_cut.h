#pragma once

#include "meshing/core/types.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Where a·x + b ≤ 0 in a plane: one side of a shadow.
struct ShadowSide {
  double ax, ay, b;

  /// Heights below this count as 0: those of what is nearer to the line than `nearness`, or up to
  /// √2 times that.
  double near(double nearness) const { return nearness * (std::abs(ax) + std::abs(ay)); }
};

struct FlatBox {
  double left = HUGE_VAL, low = HUGE_VAL, right = -HUGE_VAL, high = -HUGE_VAL;

  static FlatBox everywhere() { return {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL}; }
  void add(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  bool meets(const FlatBox& other) const {
    // All of them without a branch: each alone is as likely as not.
    return ((left <= other.right) & (right >= other.left) & (low <= other.high) &
            (high >= other.low)) != 0;
  }
};

/// Adds sides of a shadow that may cross a box. False, and none, if all of it lies outside of one.
bool add_crossing(std::span<const ShadowSide> sides, const FlatBox& box, double nearness,
                  std::vector<ShadowSide>& crossing);

/// What is left of convex polygons when convex shadows are cut off (Sutherland and Hodgman 1974):
/// as FlatParts, but without borders.
class ShadowCut {
 public:
  /// Corners of a convex polygon, counter-clockwise.
  struct Corners {
    const double *x, *y;
    std::size_t count;
  };

  void clear();
  void add(Corners part);
  std::size_t count() const { return parts_.size(); }

  /// Cuts off what lies in all of some half-planes; `use` gets each piece of it. Nothing of it lies
  /// outside of `reach`. Unless `needs_rest`, what is left of parts that are cut is only counted.
  template <class Use>
  void cut_off(std::span<const ShadowSide> shadow, const FlatBox& reach, double nearness,
               bool needs_rest, Use use) {
    const std::size_t count = parts_.size();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Part part = parts_[k];
      if (!reach.meets(part.box) || !cut_off(shadow, part, nearness, needs_rest))
        parts_[kept++] = part;
      else if (cut_count_ > 2)
        use(Corners{cut_x_.data(), cut_y_.data(), cut_count_});
    }
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(kept),
                 parts_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  /// What of one convex polygon lies in all of some half-planes: fewer than three corners, if
  /// nothing does. It holds until the next call.
  Corners common(Corners polygon, std::span<const ShadowSide> shadow, double nearness);

 private:
  struct Part {
    std::size_t first, count;
    FlatBox box;
  };

  bool cut_off(std::span<const ShadowSide> shadow, const Part& part, double nearness,
               bool needs_rest);
  void take(Corners polygon);
  void reserve(std::size_t corners);
  template <class Leave>
  void cut_at_line(Leave leave);
  void keep_inside();
  void split();
  /// Heights of what is cut over a side: the least and the most.
  struct Heights {
    double least, most;
  };
  Heights find_heights(const ShadowSide& side, double nearness);

  std::vector<Part> parts_;
  std::vector<double> x_, y_;          ///< of parts
  std::vector<double> cut_x_, cut_y_;  ///< what is cut: the first `cut_count_`
  std::vector<double> next_x_, next_y_, heights_;
  std::size_t cut_count_ = 0;
  std::vector<ShadowSide> crossing_;  ///< sides of a shadow that cross a part
};

}  // namespace halfshade
