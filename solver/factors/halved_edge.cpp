#include "solver/factors/blocked_cell.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Cells are halved across an edge along which at least this share of the most changes: layers
/// before edges of surfaces are cut into strips.
constexpr double nearly_most = 0.5;

}  // namespace

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
