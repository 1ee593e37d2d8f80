#include "meshing/geometry/hilbert_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

TEST(HilbertCurve, GoesFromNeighbourToNeighbourThroughAllCells) {
  for (const int side : {1, 2, 8, 32}) {
    std::vector<std::pair<int, int>> cells(static_cast<std::size_t>(side * side), {-1, -1});
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const int place = place_on_hilbert_curve(side, x, y);
        ASSERT_GE(place, 0);
        ASSERT_LT(place, side * side);
        cells[static_cast<std::size_t>(place)] = {x, y};
      }
    for (std::size_t k = 1; k < cells.size(); ++k)
      EXPECT_EQ(std::abs(cells[k].first - cells[k - 1].first) +
                    std::abs(cells[k].second - cells[k - 1].second),
                1)
          << side << ' ' << k;
  }
}

}  // namespace
}  // namespace halfshade
