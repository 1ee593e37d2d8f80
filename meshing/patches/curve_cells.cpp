#include "meshing/patches/curve_cells.h"

#include <algorithm>

namespace halfshade {

CurveCells curve_cells(const ElementTable& elements) {
  CurveCells cells;
  cells.elements.reserve(elements.corners.size());
  std::vector<char> is_taken(elements.corners.size(), 0);
  for (int seed = 0; seed < elements.count(); ++seed) {
    if (is_taken[at(seed)] != 0) continue;
    const std::size_t begin = cells.elements.size();
    cells.first.push_back(static_cast<int>(begin));
    cells.elements.push_back(seed);
    is_taken[at(seed)] = 1;
    for (std::size_t next = begin; next < cells.elements.size(); ++next) {
      const auto e = at(cells.elements[next]);
      for (std::size_t k = 0; k < 3; ++k) {
        const int across = elements.neighbours[e][k];
        if (across < 0 || elements.edge_order[e][k] >= 0 || is_taken[at(across)] != 0) continue;
        is_taken[at(across)] = 1;
        cells.elements.push_back(across);
      }
    }
    std::sort(cells.elements.begin() + static_cast<std::ptrdiff_t>(begin), cells.elements.end());
  }
  cells.first.push_back(static_cast<int>(cells.elements.size()));
  return cells;
}

}  // namespace halfshade
