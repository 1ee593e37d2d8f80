#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/polynomial.h"

#include <array>
#include <cstddef>
#include <vector>

namespace halfshade {

/// A place in one of several triangles.
struct ForestPlace {
  int triangle = -1;  ///< −1: nowhere
  TrianglePlace place = TrianglePlace::Zero();
};

/// Finds the element that a point of a surface lies in, by a grid over each surface whose cells are
/// quartered where elements are small. Cost: a few elements a query, whatever their number; more in
/// the smallest cells.
class ElementLookup {
 public:
  explicit ElementLookup(const ElementTable& elements);

  /// The first element that holds the point; the one where its barycentric coordinates are least
  /// negative, moved to its border, if rounding puts it outside of all. Nowhere if the surface has
  /// no elements.
  ForestPlace find(int surface, const Vec3& position) const;

  /// Cells, and elements in them, which are what takes memory: 8 bytes and 4.
  std::size_t entries() const { return cells_.size() + items_.size(); }

 private:
  /// Takes points of a surface to places in a triangle of it.
  struct PlaceMap {
    Vec3 origin;
    Eigen::Matrix<double, 2, 3> slope;
  };
  /// In the surface's plane, which a splinter between corners that lie off it by rounding may cross
  /// at any angle. NaN if nothing of the triangle is left there.
  static PlaceMap map_to_places(const std::array<Vec3, 3>& triangle, const Vec3& normal);
  /// Cells of a surface: columns and rows; cell (i, j) is at first_cell + i + j columns.
  struct Grid {
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix<double, 2, 3> to_cells = Eigen::Matrix<double, 2, 3>::Zero();
    int columns = 0, rows = 0;
    int first_cell = 0;
    std::vector<int> elements;
  };

  /// The elements of a cell, from `first` to `end` in the list; of one that is quartered its first
  /// quarter, and −1. Quarters follow each other: low, right, upper left, upper right.
  struct Cell {
    int first, end;
  };
  /// Triangles in coordinates in which cells of the grid are unit squares.
  using FlatTriangles = std::vector<std::array<Vec2, 3>>;

  void fill(const ElementTable& elements, Grid& grid);
  /// `is_fewer`: inside the cell are fewer than in the one that it is a quarter of.
  void fill_cell(const FlatTriangles& triangles, std::vector<int> inside, int cell, const Vec2& low,
                 int quarterings, bool is_fewer);
  const Cell& cell_at(const Grid& grid, Vec2 q) const;

  std::vector<PlaceMap> maps_;
  std::vector<Grid> grids_;  ///< of each surface
  std::vector<Cell> cells_;
  std::vector<int> items_;
};

}  // namespace halfshade
