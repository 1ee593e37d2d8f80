#include "meshing/geometry/convex_hull.h"

#include "meshing/core/planar.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace halfshade {

std::vector<std::size_t> convex_hull(std::span<const Vec2> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::pair(points[i].x(), points[i].y()) < std::pair(points[j].x(), points[j].y());
  });
  std::vector<std::size_t> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const std::size_t i : order) {
      const auto turns_left = [&] {
        const Vec2 &before = points[hull[hull.size() - 2]], &last = points[hull.back()];
        return cross_2d(last - before, points[i] - last) > 0;
      };
      while (hull.size() >= start + 2 && !turns_left()) hull.pop_back();
      hull.push_back(i);
    }
    hull.pop_back();  // the other half begins with it
    std::reverse(order.begin(), order.end());
  }
  return hull;
}

}  // namespace halfshade
