#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade::detail {

/// Linear values in [0,1] of 8-bit sRGB; the inverse of encode_srgb.
Rgb decode_srgb(const std::array<std::uint8_t, 3>& bytes);
/// The same for encoded values in [0,1].
Rgb linear_of_srgb(const Rgb& encoded);

/// A picture of linear colours that smooth lines are drawn into. Coordinates are in pixels; the
/// first one covers [0,1] × [0,1], rows come one below the other.
class LineCanvas {
 public:
  LineCanvas(int width, int height, const Rgb& background);

  int width() const { return width_; }
  int height() const { return height_; }

  void set(std::size_t pixel, const Rgb& colour) { colours_[pixel] = colour; }

  /// Paints over the pixels from (x, y) on; what lies outside the picture is left out.
  void fill(int x, int y, int width, int height, const Rgb& colour);

  /// Mixes a share of a colour into a pixel; nothing outside the picture.
  void blend(int x, int y, double share, const Rgb& colour);

  /// A polyline, blended once however often it meets a pixel. `width` in pixels, > 0.
  void line(std::span<const Vec2> points, double width, const Rgb& colour);

  /// sRGB, three bytes a pixel.
  std::vector<std::uint8_t> bytes() const;

 private:
  void cover(const Vec2& a, const Vec2& b, double width);

  int width_, height_;
  std::vector<Rgb> colours_;
  std::vector<double> covered_;  ///< by the present line
  std::vector<std::size_t> touched_;
};

}  // namespace halfshade::detail
