#pragma once

#include "meshing/patches/element_table.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/element_field.h"
#include "tests/support/random.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace halfshade::test {

struct ElementPoint {
  int surface = 0;
  SurfacePoint point;
};

/// Points spread evenly over all elements, one in each of as many equal parts of the area.
inline std::vector<ElementPoint> spread_points(const ElementTable& elements, int count,
                                               Random& random) {
  std::vector<double> sums(elements.area.size());
  std::partial_sum(elements.area.begin(), elements.area.end(), sums.begin());
  std::vector<ElementPoint> points;
  for (int i = 0; i < count; ++i) {
    const double at_area = (i + random(0, 1)) / count * sums.back();
    const auto place = std::lower_bound(sums.begin(), sums.end() - 1, at_area) - sums.begin();
    const int e = static_cast<int>(place);
    const double across = std::sqrt(random(0, 1)), along = random(0, 1);
    const Vec3 p = position(elements.triangle(e), {across * (1 - along), across * along});
    points.push_back({elements.surface[at(e)], {p, elements.normal[at(e)]}});
  }
  return points;
}

}  // namespace halfshade::test
