#include "meshing/arrangement/triangles_inside.h"

#include <algorithm>

namespace halfshade {

std::vector<bool> triangles_inside(const HullTriangulation& hull, std::span<const Link> border) {
  const auto is_border = [&](int a, int b) {
    return std::binary_search(border.begin(), border.end(), sorted_link(a, b));
  };
  std::vector<int> mark(hull.triangles.size(), -1);
  std::vector<int> open;
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (hull.neighbours[t][k] < 0 && mark[t] < 0) {
        mark[t] = is_border(hull.triangles[t][k], hull.triangles[t][(k + 1) % 3]) ? 1 : 0;
        open.push_back(static_cast<int>(t));
      }
  while (!open.empty()) {
    const auto t = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int next = hull.neighbours[t][k];
      if (next < 0 || mark[static_cast<std::size_t>(next)] >= 0) continue;
      const bool crosses = is_border(hull.triangles[t][k], hull.triangles[t][(k + 1) % 3]);
      mark[static_cast<std::size_t>(next)] = crosses ? 1 - mark[t] : mark[t];
      open.push_back(next);
    }
  }
  return {mark.begin(), mark.end()};
}

}  // namespace halfshade
