#pragma once

#include "meshing/core/texture.h"

#include <array>
#include <span>
#include <vector>

/// What a polygon shows of a picture, on a grid that follows the picture's texels.
namespace halfshade::reading {

/// Lines at right angles to one axis of a picture: line k is at (first + k) / fineness.
struct GridLines {
  double fineness = 1, first = 0;
  int cells = 1;  ///< between the first line and the last

  double line(int k) const { return (first + k) / fineness; }
};

/// The cells from `low` to before `end` along u and v. The outermost ones have no end.
struct GridBlock {
  std::array<int, 2> low, end;
};

struct PictureGrid {
  std::array<GridLines, 2> lines;  ///< across u and v
  std::vector<double> area;        ///< of the polygon in each cell, rows from the lowest
  std::vector<Rgb> value;          ///< of the picture

  std::size_t cell(int column, int row) const { return at(row * lines[0].cells + column); }
  GridBlock whole() const { return {{0, 0}, {lines[0].cells, lines[1].cells}}; }
};

enum class GridFineness { usual, fine, finest };

/// Cells are texels; where these are many, blocks of them, of a smaller copy of the picture if need
/// be; where they are few, parts of them, for pictures are linear between the centres of texels.
PictureGrid make_picture_grid(const Paint& paint, std::span<const Vec3> polygon,
                              GridFineness fineness = GridFineness::usual);

/// The part of a polygon that lies in a block. One that is not convex may be left with edges that
/// run back and forth along the block's sides, where nothing lies between.
std::vector<Vec3> part_in(const GridBlock& block, const PictureGrid& grid, const Paint& paint,
                          std::vector<Vec3> polygon);

}  // namespace halfshade::reading
