#include "io/chart/chart.h"

#include "io/chart/chart_layout.h"
#include "io/files/atomic_file.h"
#include "io/picture/picture.h"

namespace halfshade {
namespace {

constexpr FileFormats chart_formats = {"charts", {".svg", ".png"}};
constexpr int pixels_a_unit = 2;  // of .png: for dense screens and paper

}  // namespace

std::string chart_svg(const Chart& chart) { return detail::drawing_svg(detail::layout(chart)); }

void write_chart(const Chart& chart, const std::filesystem::path& path) {
  require_format(path, chart_formats);
  if (extension_of(path) == ".svg") return write_atomically(path, chart_svg(chart));
  const detail::Drawing drawing = detail::layout(chart);
  Picture picture;
  picture.width = pixels_a_unit * drawing.width;
  picture.height = pixels_a_unit * drawing.height;
  picture.pixels = detail::drawing_pixels(drawing, pixels_a_unit);
  write_png(picture, path);
}

}  // namespace halfshade
