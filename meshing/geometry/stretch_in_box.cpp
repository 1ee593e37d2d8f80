#include "meshing/geometry/stretch_in_box.h"

#include <algorithm>

namespace halfshade {

std::optional<std::pair<double, double>> stretch_in_box(const Vec2& from, const Vec2& to,
                                                        const Vec2& low, const Vec2& high) {
  double first = 0, last = 1;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double along = to[k] - from[k], up_to_low = low[k] - from[k],
                 up_to_high = high[k] - from[k];
    if (along == 0) {
      if (up_to_low > 0 || up_to_high < 0) return std::nullopt;
      continue;
    }
    const double a = up_to_low / along, b = up_to_high / along;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return std::nullopt;
  return std::pair(first, last);
}

}  // namespace halfshade
