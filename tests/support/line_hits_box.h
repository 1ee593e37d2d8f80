#pragma once

#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>

namespace halfshade::test {

/// Whether the infinite line through two points meets a box, by slabs.
inline bool line_hits_box(const Vec3& from, const Vec3& to, const Bounds& box) {
  double near = -HUGE_VAL, far = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const double a = (box.low[k] - from[k]) / (to[k] - from[k]);
    const double b = (box.high[k] - from[k]) / (to[k] - from[k]);
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

}  // namespace halfshade::test
