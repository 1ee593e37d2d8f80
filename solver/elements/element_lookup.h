#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/polynomial.h"

#include <vector>

namespace halfshade {

/// A place in one of several triangles.
struct ForestPlace {
  int triangle = -1;  ///< −1: nowhere
  TrianglePlace place = TrianglePlace::Zero();
};

/// Finds the element that a point of a surface lies in, by a grid over each surface. Cost: a few
/// elements a query, whatever their number, unless they are very uneven.
class ElementLookup {
 public:
  explicit ElementLookup(const ElementTable& elements);

  /// The first element that holds the point; the one where its barycentric coordinates are least
  /// negative, moved to its border, if rounding puts it outside of all. Nowhere if the surface has
  /// no elements.
  ForestPlace find(int surface, const Vec3& position) const;

 private:
  /// Takes points of a triangle's plane to places.
  struct PlaceMap {
    Vec3 origin;
    Eigen::Matrix<double, 2, 3> slope;
  };
  /// Cells of a surface: columns and rows; `starts` of cell (i, j) is at first_cell + i + j
  /// columns.
  struct Grid {
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix<double, 2, 3> to_cells = Eigen::Matrix<double, 2, 3>::Zero();
    int columns = 0, rows = 0;
    int first_cell = 0;
    std::vector<int> elements;
  };

  void fill(const ElementTable& elements, Grid& grid);
  int cell_of(const Grid& grid, const Vec2& q) const;

  std::vector<PlaceMap> maps_;
  std::vector<Grid> grids_;  ///< of each surface
  std::vector<int> starts_, items_;
};

}  // namespace halfshade
