#include "io/picture/legend.h"

#include "io/picture/linear_ticks.h"
#include "io/picture/mesh_line.h"
#include "io/picture/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade::detail {
namespace {

/// Linear.
const Rgb ink = Rgb::Constant(0.8), faint = Rgb::Constant(0.2);
/// Font size, as a share of the picture's height and at least and at most in pixels.
constexpr double text_share = 1 / 42., least_text = 9, most_text = 60;
/// Lengths in font sizes.
constexpr double legend_margin = 0.8, bar_width = 1.4, label_gap = 0.6, line_height = 1.35,
                 tick_distance = 2.2;
/// Decades over which 2 and 5 have room, too.
constexpr double short_legend = 3;
/// Ticks at the very ends may be off by this share of the range.
constexpr double rounding = 1e-6;
/// Codes that have boxes of their own.
constexpr int most_boxes = 16;
constexpr std::array<const char*, 4> region_names = {"lit", "penumbra", "umbra", "away"};

double text_size(int picture_height) {
  return std::clamp(std::round(text_share * picture_height), least_text, most_text);
}

bool has_boxes(const Legend& legend) {
  return legend.is_whole && legend.scale == ValueScale::linear &&
         legend.range.high - legend.range.low < most_boxes;
}

std::string code_label(const Legend& legend, int code) {
  if (legend.is_region && code >= 0 && code < static_cast<int>(region_names.size()))
    return fmt::format("{} {}", code, region_names.at(at(code)));
  return fmt::format("{}", code);
}

/// Where the bar lies.
struct Bar {
  double size;  ///< of the font
  double top, bottom;
  /// The row of a share of the range.
  double row(double share) const { return bottom + share * (top - bottom); }
};

Bar bar_of(const Legend& legend, int picture_height) {
  const double size = text_size(picture_height);
  const double lines = static_cast<double>(legend.title.size()) + 1;
  return {size, std::min(legend_margin * size + line_height * size * lines, picture_height - 1.),
          std::max(picture_height - 1.5 * size, 1.)};
}

std::vector<Tick> legend_ticks(const Legend& legend, const Bar& bar) {
  std::vector<Tick> result;
  const ValueRange& range = legend.range;
  if (has_boxes(legend)) {
    for (double code = std::ceil(range.low); code <= range.high; ++code)
      result.push_back({code, code_label(legend, static_cast<int>(code))});
    return result;
  }
  if (legend.scale == ValueScale::log)
    return ticks(LogAxis{std::log10(range.low), std::log10(range.high), bar.bottom, bar.top},
                 short_legend);
  const double length = std::abs(bar.bottom - bar.top);
  const int most = std::max(2, static_cast<int>(length / (tick_distance * bar.size)));
  return linear_ticks(range.low, range.high, most, legend.is_whole);
}

/// Boxes lie around their codes, so that the bar is half a code longer at either end.
double bar_share(const Legend& legend, double value) {
  if (!has_boxes(legend)) return share_in(legend.range, legend.scale, value);
  const double low = std::ceil(legend.range.low), high = std::floor(legend.range.high);
  return (value - low + 0.5) / (high - low + 1);
}

Rgb bar_colour(const Legend& legend, const ColourTable& colours, double share) {
  if (!has_boxes(legend)) return colours.at(share);
  const double low = std::ceil(legend.range.low), high = std::floor(legend.range.high);
  const double code = std::min(low + std::floor(share * (high - low + 1)), high);
  return colours.at(share_in(legend.range, legend.scale, code));
}

/// A point upwards or downwards at an end that values go beyond.
void draw_beyond(LineCanvas& canvas, double x, double width, double row, double height,
                 const Rgb& colour) {
  const int rows = static_cast<int>(std::abs(height));
  for (int k = 0; k < rows; ++k) {
    const double share = 1 - (k + 0.5) / rows;
    const double half = share * width / 2;
    const int y = static_cast<int>(std::floor(row + (height < 0 ? -1 - k : k)));
    canvas.fill(static_cast<int>(std::lround(x + width / 2 - half)), y,
                std::max(1, static_cast<int>(std::lround(2 * half))), 1, colour);
  }
}

void draw_bar(LineCanvas& canvas, double x, const Legend& legend, const Bar& bar) {
  const ColourTable colours(legend.map);
  const int left = static_cast<int>(std::lround(x));
  const int width = static_cast<int>(std::lround(bar_width * bar.size));
  const int top = static_cast<int>(bar.top), bottom = static_cast<int>(bar.bottom);
  for (int y = top; y < bottom; ++y)
    canvas.fill(left, y, width, 1,
                bar_colour(legend, colours, (bottom - y - 0.5) / (bottom - top)));
  const double point = 0.7 * bar.size;
  if (legend.above) draw_beyond(canvas, left, width, top - 1, -point, colours.at(1));
  if (legend.below) draw_beyond(canvas, left, width, bottom + 1, point, colours.at(0));
}

}  // namespace

int legend_width(const Legend& legend, int picture_height) {
  const Bar bar = bar_of(legend, picture_height);
  int text = 0;
  for (const Tick& tick : legend_ticks(legend, bar))
    text = std::max(text, text_width(tick.label, bar.size));
  double width = (bar_width + label_gap) * bar.size + text;
  for (const std::string& line : legend.title)
    width = std::max<double>(width, text_width(line, bar.size));
  return static_cast<int>(std::ceil(width + 2 * legend_margin * bar.size));
}

void draw_legend(LineCanvas& canvas, int x, const Legend& legend) {
  const Bar bar = bar_of(legend, canvas.height());
  canvas.fill(x, 0, canvas.width() - x, canvas.height(), background);
  const double left = x + legend_margin * bar.size;
  double base = legend_margin * bar.size + 0.8 * bar.size;
  for (const std::string& line : legend.title) {
    draw_text(canvas, {left, base}, line, {bar.size, Anchor::start, ink});
    base += line_height * bar.size;
  }
  draw_bar(canvas, left, legend, bar);
  const double end = left + bar_width * bar.size;
  for (const Tick& tick : legend_ticks(legend, bar)) {
    const double share = bar_share(legend, tick.value);
    if (!(share > -rounding && share < 1 + rounding)) continue;
    const double y = bar.row(share);
    const std::array<Vec2, 2> mark = {Vec2(end, y), Vec2(end + 0.3 * bar.size, y)};
    canvas.line(mark, 1, tick.label.empty() ? faint : ink);
    draw_text(canvas, {end + label_gap * bar.size, y + 0.35 * bar.size}, tick.label,
              {bar.size, Anchor::start, ink});
  }
}

}  // namespace halfshade::detail
