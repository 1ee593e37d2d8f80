#pragma once

#include "meshing/patches/element_table.h"

#include <span>
#include <vector>

namespace halfshade {

/// The cells into which curves, contact lines and borders part the elements: two elements with an
/// edge in common that lies on none of them are in one cell.
struct CurveCells {
  std::vector<int> first;  ///< [cell] where its elements start in `elements`; one more at the end
  std::vector<int> elements;  ///< cell by cell, in ascending order within each

  std::size_t count() const { return first.size() - 1; }
  std::span<const int> of(std::size_t cell) const {
    return {elements.data() + first[cell], at(first[cell + 1] - first[cell])};
  }
};

/// In the order of each cell's first element. O(n) in the number of elements.
CurveCells curve_cells(const ElementTable& elements);

}  // namespace halfshade
