#include "io/picture/line_canvas.h"

#include "io/files/srgb.h"
#include "io/picture/tone_map.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>

namespace halfshade::detail {

Rgb linear_of_srgb(const Rgb& encoded) {
  return encoded.unaryExpr([](double v) { return from_srgb(v); });
}

Rgb decode_srgb(const std::array<std::uint8_t, 3>& bytes) {
  return linear_of_srgb(Rgb(bytes[0] / 255., bytes[1] / 255., bytes[2] / 255.));
}

LineCanvas::LineCanvas(int width, int height, const Rgb& background)
    : width_(width),
      height_(height),
      colours_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background),
      covered_(colours_.size(), 0) {}

void LineCanvas::blend(int x, int y, double share, const Rgb& colour) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Rgb& pixel = colours_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x)];
  pixel += share * (colour - pixel);
}

void LineCanvas::fill(int x, int y, int width, int height, const Rgb& colour) {
  for (int row = std::max(y, 0); row < std::min(y + height, height_); ++row)
    for (int column = std::max(x, 0); column < std::min(x + width, width_); ++column)
      colours_[at(row) * at(width_) + at(column)] = colour;
}

void LineCanvas::line(std::span<const Vec2> points, double width, const Rgb& colour) {
  for (std::size_t k = 0; k + 1 < points.size(); ++k) cover(points[k], points[k + 1], width);
  for (const std::size_t pixel : touched_) {
    colours_[pixel] += covered_[pixel] * (colour - colours_[pixel]);
    covered_[pixel] = 0;
  }
  touched_.clear();
}

/// The share of a pixel within half a width of the segment, by the distance of its centre. Row by
/// row, so that a long oblique segment does not visit its whole bounding box.
void LineCanvas::cover(const Vec2& a, const Vec2& b, double width) {
  const double reach = width / 2 + 0.5, most = std::min(1., width);
  const Vec2 along = b - a;
  const auto index = [](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x), 0., count - 1.));
  };
  const int last_row = index(std::max(a.y(), b.y()) + reach, height_);
  for (int y = index(std::min(a.y(), b.y()) - reach, height_); y <= last_row; ++y) {
    // The part of the segment that comes within reach of this row.
    double s0 = 0, s1 = 1;
    if (std::abs(along.y()) > 0) {
      s0 = (y - reach - a.y()) / along.y();
      s1 = (y + 1 + reach - a.y()) / along.y();
      if (s0 > s1) std::swap(s0, s1);
      s0 = std::clamp(s0, 0., 1.);
      s1 = std::clamp(s1, 0., 1.);
    }
    const double x0 = a.x() + s0 * along.x(), x1 = a.x() + s1 * along.x();
    const int last_column = index(std::max(x0, x1) + reach, width_);
    for (int x = index(std::min(x0, x1) - reach, width_); x <= last_column; ++x) {
      const Vec2 p(x + 0.5, y + 0.5);
      const double share = std::clamp(reach - distance_to_segment(p, a, b), 0., most);
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                static_cast<std::size_t>(x);
      if (!(share > covered_[pixel])) continue;
      if (covered_[pixel] == 0) touched_.push_back(pixel);
      covered_[pixel] = share;
    }
  }
}

std::vector<std::uint8_t> LineCanvas::bytes() const {
  std::vector<std::uint8_t> result;
  result.reserve(3 * colours_.size());
  for (const Rgb& colour : colours_) {
    const auto encoded = encode_srgb(colour);
    result.insert(result.end(), encoded.begin(), encoded.end());
  }
  return result;
}

}  // namespace halfshade::detail
