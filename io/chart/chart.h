#pragma once

#include "meshing/core/types.h"

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// Points of one kind, joined in their order.
struct ChartSeries {
  std::string name;
  std::vector<Vec2> points;  ///< those that are not finite and above zero are left out
};

/// A chart with logarithmic axes. Texts are ASCII.
struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartSeries> series;  ///< the first one is drawn on top of the others
  bool equal_line = false;          ///< a line where x = y
  /// Values of y below this are drawn as a shaded band: nothing is known there; 0: none.
  double unknown_below = 0;
};

/// The chart as an SVG element of its own size, to stand in a file or in a page. Texts stay texts.
std::string chart_svg(const Chart& chart);

/// Writes it as .svg or .png. Needs no display. Throws Error(usage) for another extension,
/// Error(unwritable).
void write_chart(const Chart& chart, const std::filesystem::path& path);

}  // namespace halfshade
