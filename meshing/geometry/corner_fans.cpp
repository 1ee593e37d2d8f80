#include "meshing/geometry/corner_fans.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
namespace {

int root(std::vector<int>& above, int i) {
  while (above[at(i)] != i) i = above[at(i)] = above[at(above[at(i)])];
  return i;
}

}  // namespace

CornerFans corner_fans(std::span<const std::array<int, 3>> triangles,
                       std::span<const std::array<int, 3>> neighbours) {
  std::vector<int> above(3 * triangles.size());
  std::iota(above.begin(), above.end(), 0);
  const auto join = [&](int corner, int triangle, int point) {
    int k = 0;
    while (triangles[at(triangle)][at(k)] != point) ++k;
    const int a = root(above, corner), b = root(above, 3 * triangle + k);
    above[at(std::max(a, b))] = std::min(a, b);
  };
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbours[at(t)][at(k)], next = (k + 1) % 3;
      if (other < t) continue;  // −1, or done from the other side
      join(3 * t + k, other, triangles[at(t)][at(k)]);
      join(3 * t + next, other, triangles[at(t)][at(next)]);
    }
  CornerFans fans;
  std::vector<int> number(above.size(), -1);
  fans.of_corner.resize(triangles.size());
  for (int c = 0; c < static_cast<int>(above.size()); ++c) {
    int& fan = number[at(root(above, c))];
    if (fan < 0) fan = fans.count++;
    fans.of_corner[at(c / 3)][at(c % 3)] = fan;
  }
  return fans;
}

std::vector<std::array<int, 3>> edge_neighbours(std::span<const std::array<int, 3>> triangles) {
  struct Side {
    int low, high, triangle, edge;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[at(t)][at(k)], b = triangles[at(t)][at((k + 1) % 3)];
      sides.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<std::array<int, 3>> neighbours(triangles.size(), {-1, -1, -1});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    neighbours[at(a.triangle)][at(a.edge)] = b.triangle;
    neighbours[at(b.triangle)][at(b.edge)] = a.triangle;
  }
  return neighbours;
}

}  // namespace halfshade
