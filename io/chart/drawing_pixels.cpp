#include "io/chart/drawing.h"
#include "io/picture/text.h"

#include <algorithm>
#include <cmath>

namespace halfshade::detail {
namespace {

Rgb linear(Colour colour) {
  const auto byte = [colour](int shift) {
    return static_cast<std::uint8_t>((colour >> shift) & 0xff);
  };
  return decode_srgb({byte(16), byte(8), byte(0)});
}

/// By strokes so close that they leave nothing out: the canvas blends them as one line.
void fill(const DrawnArea& area, double scale, LineCanvas& canvas) {
  constexpr double stroke = 1.5, spacing = 0.5;
  double low = 1e9, high = -1e9;
  for (const Vec2& p : area.corners) {
    low = std::min(low, scale * p.y());
    high = std::max(high, scale * p.y());
  }
  std::vector<Vec2> strokes;
  const std::size_t n = area.corners.size();
  for (double y = low + stroke / 2; y <= high - stroke / 2; y += spacing) {
    double first = 1e9, last = -1e9;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 a = scale * area.corners[k], b = scale * area.corners[(k + 1) % n];
      if ((a.y() < y) == (b.y() < y)) continue;
      const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      first = std::min(first, x);
      last = std::max(last, x);
    }
    if (last < first) continue;
    const double inset = std::min(stroke / 2, (last - first) / 2);
    strokes.emplace_back(first + inset, y);
    strokes.emplace_back(last - inset, y);
    if (strokes.size() % 4 == 0) std::swap(strokes.back(), *(strokes.end() - 2));
  }
  canvas.line(strokes, stroke, linear(area.colour));
}

void draw(const DrawnLine& line, double scale, LineCanvas& canvas) {
  constexpr double dash = 6, gap = 4;
  std::vector<Vec2> points;
  for (const Vec2& p : line.points) points.push_back(scale * p);
  if (points.size() < 2) return;
  if (!line.dashed) return canvas.line(points, scale * line.width, linear(line.colour));
  const Vec2 way = points.back() - points.front();  // straight
  const double length = way.norm();
  for (double done = 0; done < length; done += scale * (dash + gap)) {
    const double end = std::min(done + scale * dash, length);
    const std::array<Vec2, 2> piece = {points.front() + done / length * way,
                                       points.front() + end / length * way};
    canvas.line(piece, scale * line.width, linear(line.colour));
  }
}

void draw(const DrawnText& text, double scale, LineCanvas& canvas) {
  draw_text(canvas, scale * text.place, text.text,
            {scale * text.size, text.anchor, linear(text.colour), text.upwards});
}

}  // namespace

std::vector<std::uint8_t> drawing_pixels(const Drawing& drawing, int scale) {
  LineCanvas canvas(scale * drawing.width, scale * drawing.height, Rgb::Ones());
  for (const DrawnArea& area : drawing.areas) fill(area, scale, canvas);
  for (const DrawnLine& line : drawing.lines) draw(line, scale, canvas);
  for (const DrawnArea& area : drawing.marks) fill(area, scale, canvas);
  for (const DrawnText& text : drawing.texts) draw(text, scale, canvas);
  return canvas.bytes();
}

}  // namespace halfshade::detail
