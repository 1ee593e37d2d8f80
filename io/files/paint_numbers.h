#pragma once

#include "meshing/core/texture.h"

#include <vector>

namespace halfshade::detail {

/// Texture, along (row by row), from, and the reflectance where the picture is white.
inline constexpr int paint_components = 12;

/// Paints as arrays of numbers, to stand in files.
struct PaintNumbers {
  std::vector<double> paints;              ///< paint_components each
  std::vector<int> sizes;                  ///< width and height of each texture
  std::vector<std::vector<int>> textures;  ///< texels of each, sRGB from 0 to 255
};

/// A paint with the reflectance of the material that it is on.
struct PaintOn {
  Paint paint;
  Rgb most = Rgb::Ones();
};

PaintNumbers to_numbers(const std::vector<PaintOn>& paints);

/// Empty if the numbers do not fit together.
std::vector<PaintOn> to_paints(const PaintNumbers& numbers);

}  // namespace halfshade::detail
