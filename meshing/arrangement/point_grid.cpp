#include "meshing/arrangement/point_grid.h"

#include "meshing/geometry/mix_bits.h"

#include <cmath>

namespace halfshade {
namespace {

// Cells that share a key share a list, which costs time and nothing else.
std::uint64_t cell_key(std::int64_t x, std::int64_t y) {
  return mix_bits(mix_bits(static_cast<std::uint64_t>(x)) + static_cast<std::uint64_t>(y));
}

}  // namespace

std::int64_t PointGrid::cell(double x) const {
  return static_cast<std::int64_t>(std::floor(x / reach_));
}

int PointGrid::first_in(std::int64_t x, std::int64_t y) const {
  const auto found = first_in_cell_.find(cell_key(x, y));
  return found == first_in_cell_.end() ? -1 : found->second;
}

void PointGrid::add(int id, const Vec2& p) {
  const int entry = static_cast<int>(entries_.size());
  const auto [first, is_first] =
      first_in_cell_.try_emplace(cell_key(cell(p.x()), cell(p.y())), entry);
  entries_.push_back({p, id, is_first ? -1 : first->second});
  first->second = entry;
}

}  // namespace halfshade
