#pragma once

#include "meshing/core/types.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {

/// All lines through two boxes, for "can one of them meet this?".
class LinesThrough {
 public:
  /// In no particular order; neither is empty.
  LinesThrough(const Bounds& a, const Bounds& b);

  const Bounds& near() const { return near_; }
  const Bounds& far() const { return far_; }

  /// False only if none of the lines meets the box, grown by `slack` ≥ 0. True for all boxes if the
  /// two that the lines run through are not farther apart than that along any axis.
  bool may_meet(const Bounds& box, double slack) const {
    if (!(gap_ > slack)) return true;
    // A line from x to y is at (1 − u) x + u y; these are all u at which one can be level with the
    // box.
    const double below = box.low[axis_] - slack, above = box.high[axis_] + slack;
    const std::array<double, 2> first = {near_.low[axis_], near_.high[axis_]};
    double u0 = HUGE_VAL, u1 = -HUGE_VAL;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        u0 = std::min(u0, (below - first[i]) * inverse_[i][j]);
        u1 = std::max(u1, (above - first[i]) * inverse_[i][j]);
      }
    for (Eigen::Index k = 0; k < 3; ++k)
      if (k != axis_ && (std::min(lowest(u0, k), lowest(u1, k)) > box.high[k] + slack ||
                         std::max(highest(u0, k), highest(u1, k)) < box.low[k] - slack))
        return false;
    return true;
  }

 private:
  // The least of linear functions is concave, so that it is least at an end of an interval of u.
  double lowest(double u, Eigen::Index k) const {
    return (1 - u) * (u <= 1 ? near_.low[k] : near_.high[k]) +
           u * (u >= 0 ? far_.low[k] : far_.high[k]);
  }
  double highest(double u, Eigen::Index k) const {
    return (1 - u) * (u <= 1 ? near_.high[k] : near_.low[k]) +
           u * (u >= 0 ? far_.high[k] : far_.low[k]);
  }

  Bounds near_, far_;       ///< the far one is higher along the axis that parts them best
  Eigen::Index axis_ = 0;   ///< …
  double gap_ = 0;          ///< … and by how much
  double inverse_[2][2]{};  ///< of the ways along it from either end of `near_` to those of `far_`
};

}  // namespace halfshade
