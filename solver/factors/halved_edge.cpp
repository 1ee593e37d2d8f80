#include "solver/factors/blocked_cell.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Cells are halved across an edge along which at least this share of the most changes: layers
/// before edges of surfaces are cut into strips.
constexpr double nearly_most = 0.5;

}  // namespace

std::array<double, 3> change_along_edges(const Vec2& moments) {
  const double along_u = 12 * (2 * moments.x() + moments.y());
  const double along_v = 12 * (moments.x() + 2 * moments.y());
  return {std::abs(along_u), std::abs(along_v - along_u), std::abs(along_v)};
}

std::array<double, 3> changes(const std::array<double, 3>& at_corners) {
  return {std::abs(at_corners[1] - at_corners[0]), std::abs(at_corners[2] - at_corners[1]),
          std::abs(at_corners[0] - at_corners[2])};
}

std::size_t edge_to_halve(const BlockedCell& cell) {
  const double most = *std::max_element(cell.change.begin(), cell.change.end());
  std::size_t longest = 0;
  double most_length = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (cell.corners[(k + 1) % 3] - cell.corners[k]).squaredNorm();
    if (cell.change[k] < nearly_most * most || length <= most_length) continue;
    longest = k;
    most_length = length;
  }
  return longest;
}

}  // namespace halfshade
