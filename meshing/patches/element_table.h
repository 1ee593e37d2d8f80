#pragma once

#include "meshing/core/types.h"

#include <array>
#include <vector>

namespace halfshade {

/// The elements of a patch mesh as plain arrays, one entry an element; what the solver and the
/// writers read. Points are split across D0 lines (contact lines) and between surfaces and shared
/// elsewhere, so that values interpolated at points do not bleed across.
struct ElementTable {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> corners;  ///< into points, counter-clockwise seen from the front
  std::vector<std::array<int, 3>> neighbours;  ///< [k]: element across the edge from corner k to
                                               ///< k+1; −1 at borders and across D0 lines
  std::vector<Vec3> normal;                    ///< unit length
  std::vector<double> area;                    ///< squared scene units
  std::vector<int> surface, face, group, material;
  std::vector<int> level;  ///< number of splits above it in the hierarchy
  /// [k]: the lowest order of the discontinuity curves along the edge from corner k to k+1 (0 on
  /// borders and contact lines); −1 where there is none.
  std::vector<std::array<int, 3>> edge_order;

  int count() const { return static_cast<int>(corners.size()); }
  /// The three corners' positions.
  std::array<Vec3, 3> triangle(int element) const {
    const auto& c = corners[at(element)];
    return {points[at(c[0])], points[at(c[1])], points[at(c[2])]};
  }
};

}  // namespace halfshade
