#pragma once

#include "io/picture/line_canvas.h"

#include <string>

namespace halfshade::detail {

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 13;  ///< of the font, pixels, > 0
  Anchor anchor = Anchor::start;
  Rgb colour = Rgb::Zero();  ///< linear
  bool upwards = false;      ///< turned by 90 degrees, to be read from the right
};

/// Writes into a picture in VTK's own font, by FreeType: the same on every machine, and without a
/// display. `place` is the start, middle or end of the base line, in pixels; UTF-8.
void draw_text(LineCanvas& canvas, const Vec2& place, const std::string& text,
               const TextStyle& style);

/// How long the base line of a text is, in pixels.
int text_width(const std::string& text, double size);

}  // namespace halfshade::detail
