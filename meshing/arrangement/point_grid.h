#pragma once

#include "meshing/core/types.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace halfshade {

/// Points of a plane by place, for the nearest one within a given reach. O(1) for adding and
/// asking, where few points lie within the reach of each other.
class PointGrid {
 public:
  /// `reach` > 0 must exceed the rounding of the coordinates by far.
  explicit PointGrid(double reach) : reach_(reach) {}

  void add(int id, const Vec2& p);

  /// Calls visit(id, distance) for all points within `radius` ≤ reach.
  template <class Visit>
  void for_each_near(const Vec2& p, double radius, const Visit& visit) const {
    const std::int64_t column = cell(p.x()), row = cell(p.y());
    for (std::int64_t x = column - 1; x <= column + 1; ++x)
      for (std::int64_t y = row - 1; y <= row + 1; ++y)
        for (int i = first_in(x, y); i >= 0; i = entries_[at(i)].next) {
          const Entry& entry = entries_[at(i)];
          if (const double distance = (entry.place - p).norm(); distance <= radius)
            visit(entry.id, distance);
        }
  }

  /// The nearest point within `radius` ≤ reach for which accept(id, distance) holds, the one with
  /// the lowest id of several, or −1.
  template <class Accept>
  int nearest(const Vec2& p, double radius, const Accept& accept) const {
    int best = -1;
    double closest = HUGE_VAL;
    for_each_near(p, radius, [&](int id, double distance) {
      // What is nearer by rounding only is not.
      constexpr double parts = 0x1p20;
      const double off = std::round(parts * distance / reach_);
      if (!(off < closest || (off == closest && id < best)) || !accept(id, distance)) return;
      closest = off;
      best = id;
    });
    return best;
  }

 private:
  struct Entry {
    Vec2 place;
    int id;
    int next;  // in the same cell, or −1
  };

  std::int64_t cell(double x) const;
  int first_in(std::int64_t x, std::int64_t y) const;

  double reach_;
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, int> first_in_cell_;
};

}  // namespace halfshade
