#include "meshing/discontinuity/stretches.h"

#include "meshing/core/planar.h"

#include <algorithm>

namespace halfshade {

std::vector<std::array<double, 2>> stretches(const Surface& receiver, const Vec2& origin,
                                             const Vec2& along) {
  std::vector<double> hits;
  for (const Ring& ring : receiver.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k] - origin, b = ring[(k + 1) % ring.size()] - origin;
      const double sa = cross_2d(along, a), sb = cross_2d(along, b);
      if ((sa > 0) == (sb > 0)) continue;
      hits.push_back(along.dot(a + sa / (sa - sb) * (b - a)) / along.squaredNorm());
    }
  std::sort(hits.begin(), hits.end());
  std::vector<std::array<double, 2>> result;
  for (std::size_t k = 1; k < hits.size(); k += 2) result.push_back({hits[k - 1], hits[k]});
  return result;
}

}  // namespace halfshade
