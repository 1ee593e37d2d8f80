#include "io/chart/chart_layout.h"

#include "io/picture/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade::detail {
namespace {

constexpr int chart_width = 760, chart_height = 460;
constexpr double left = 78, right = 600, top = 44, bottom = 404;
constexpr double mark_size = 4.5;

/// Okabe and Ito (2008): told apart also by the colour-blind; then three more.
constexpr std::array<Colour, 10> colours = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00,
                                            0x56b4e9, 0x555555, 0x7f4f24, 0x6a51a3, 0x9a9a00};
constexpr Colour grid = 0xe9e9e9, grid_labelled = 0xcfcfcf, frame = 0x777777, band = 0xf3f1ea;

bool can_be_drawn(const Vec2& p) { return p.allFinite() && (p.array() > 0).all(); }

struct Axes {
  LogAxis x, y;
  Vec2 at(const Vec2& p) const { return {x.at(p.x()), y.at(p.y())}; }
};

Axes axes_of(const Chart& chart) {
  std::vector<double> x, y;
  for (const ChartSeries& series : chart.series)
    for (const Vec2& p : series.points)
      if (can_be_drawn(p)) {
        x.push_back(p.x());
        y.push_back(p.y());
      }
  return {fitting_axis(x, left, right), fitting_axis(y, bottom, top)};
}

void draw_axes(const Chart& chart, const Axes& axes, Drawing& drawing) {
  for (const Tick& tick : ticks(axes.x)) {
    const double x = axes.x.at(tick.value);
    const bool plain = tick.label.empty();
    drawing.lines.push_back({{{x, top}, {x, bottom}}, 1, plain ? grid : grid_labelled});
    if (!plain) drawing.texts.push_back({{x, bottom + 18}, tick.label, 12, Anchor::middle});
  }
  for (const Tick& tick : ticks(axes.y)) {
    const double y = axes.y.at(tick.value);
    const bool plain = tick.label.empty();
    drawing.lines.push_back({{{left, y}, {right, y}}, 1, plain ? grid : grid_labelled});
    if (!plain) drawing.texts.push_back({{left - 8, y + 4}, tick.label, 12, Anchor::end});
  }
  drawing.lines.push_back(
      {{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}, 1, frame});
  drawing.texts.push_back({{left, top - 18}, chart.title, 15, Anchor::start, 0x111111});
  drawing.texts.push_back({{(left + right) / 2, bottom + 42}, chart.x_label, 13, Anchor::middle});
  drawing.texts.push_back(
      {{22, (top + bottom) / 2}, chart.y_label, 13, Anchor::middle, 0x333333, true});
}

/// Discs, squares, triangles and diamonds in turn.
DrawnArea mark(const Vec2& centre, std::size_t kind, double size) {
  struct Shape {
    int corners;
    double turn, size;
  };
  constexpr std::array<Shape, 4> shapes = {
      {{24, 0, 1}, {4, 0.125, 1.25}, {3, 0.75, 1.35}, {4, 0, 1.3}}};
  const Shape& shape = shapes.at(kind % shapes.size());
  DrawnArea area{{}, colours.at(kind % colours.size())};
  for (int k = 0; k < shape.corners; ++k) {
    const double angle =
        2 * std::numbers::pi * (shape.turn + static_cast<double>(k) / shape.corners);
    area.corners.push_back(centre + size * shape.size * Vec2(std::cos(angle), std::sin(angle)));
  }
  return area;
}

void draw_series(const Chart& chart, const Axes& axes, Drawing& drawing) {
  for (std::size_t k = chart.series.size(); k-- > 0;) {
    DrawnLine line{{}, k == 0 ? 3. : 1.8, colours.at(k % colours.size())};
    for (const Vec2& p : chart.series[k].points)
      if (can_be_drawn(p)) line.points.push_back(axes.at(p));
    for (const Vec2& p : line.points)
      drawing.marks.push_back(mark(p, k, k == 0 ? mark_size + 1 : mark_size));
    drawing.lines.push_back(std::move(line));
  }
}

void draw_legend(const Chart& chart, Drawing& drawing) {
  constexpr double x = right + 16, line_height = 24;
  double y = top + 12;
  for (std::size_t k = 0; k < chart.series.size(); ++k, y += line_height) {
    drawing.lines.push_back(
        {{{x, y}, {x + 22, y}}, k == 0 ? 3. : 1.8, colours.at(k % colours.size())});
    drawing.marks.push_back(mark({x + 11, y}, k, mark_size));
    drawing.texts.push_back({{x + 30, y + 4}, chart.series[k].name, 12});
  }
}

/// The part of the line x = y that lies on the chart.
void draw_equal_line(const Axes& axes, Drawing& drawing) {
  const double low = std::max(axes.x.low, axes.y.low), high = std::min(axes.x.high, axes.y.high);
  if (low >= high) return;
  const auto place = [&](double power) { return axes.at(Vec2::Constant(std::pow(10., power))); };
  drawing.lines.push_back({{place(low), place(high)}, 1.2, 0x555555, true});
}

void draw_unknown(const Chart& chart, const Axes& axes, Drawing& drawing) {
  if (!(chart.unknown_below > 0)) return;
  const double y = std::clamp(axes.y.at(chart.unknown_below), top, bottom);
  drawing.areas.push_back({{{left, y}, {right, y}, {right, bottom}, {left, bottom}}, band});
}

}  // namespace

Drawing layout(const Chart& chart) {
  Drawing drawing;
  drawing.width = chart_width;
  drawing.height = chart_height;
  const Axes axes = axes_of(chart);
  draw_unknown(chart, axes, drawing);
  draw_axes(chart, axes, drawing);
  if (chart.equal_line) draw_equal_line(axes, drawing);
  draw_series(chart, axes, drawing);
  draw_legend(chart, drawing);
  return drawing;
}

}  // namespace halfshade::detail
