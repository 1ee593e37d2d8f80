#pragma once

#include "io/picture/text.h"
#include "meshing/core/types.h"

#include <cstdint>
#include <string>
#include <vector>

/// What a chart consists of, for whatever draws it. Coordinates are pixels, y downwards.
namespace halfshade::detail {

using Colour = std::uint32_t;  ///< 0xrrggbb

struct DrawnLine {
  std::vector<Vec2> points;
  double width = 1;
  Colour colour = 0;
  bool dashed = false;
};

/// A convex polygon.
struct DrawnArea {
  std::vector<Vec2> corners;
  Colour colour = 0;
};

struct DrawnText {
  Vec2 place;  ///< of the base line's start, middle or end
  std::string text;
  double size = 13;  ///< pixels
  Anchor anchor = Anchor::start;
  Colour colour = 0x333333;
  bool upwards = false;  ///< turned by 90 degrees, to be read from the right
};

/// Areas lie below lines, those below marks, and texts on top of all.
struct Drawing {
  int width = 0, height = 0;
  std::vector<DrawnArea> areas;
  std::vector<DrawnLine> lines;
  std::vector<DrawnArea> marks;
  std::vector<DrawnText> texts;
};

std::string drawing_svg(const Drawing& drawing);

/// sRGB, three bytes a pixel, `scale` pixels for each of the drawing.
std::vector<std::uint8_t> drawing_pixels(const Drawing& drawing, int scale);

}  // namespace halfshade::detail
