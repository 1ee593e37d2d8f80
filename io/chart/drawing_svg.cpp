#include "io/chart/drawing.h"

#include <fmt/format.h>

#include <iterator>
#include <span>

namespace halfshade::detail {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

std::string point_list(std::span<const Vec2> points) {
  std::string list;
  for (const Vec2& p : points)
    fmt::format_to(std::back_inserter(list), "{}{:.1f},{:.1f}", list.empty() ? "" : " ", p.x(),
                   p.y());
  return list;
}

std::string area_svg(const DrawnArea& area) {
  return fmt::format("<polygon points=\"{}\" fill=\"#{:06x}\"/>\n", point_list(area.corners),
                     area.colour);
}

const char* anchor_name(Anchor anchor) {
  switch (anchor) {
    case Anchor::start:
      return "start";
    case Anchor::middle:
      return "middle";
    default:
      return "end";
  }
}

}  // namespace

std::string drawing_svg(const Drawing& drawing) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"Arial, Helvetica, sans-serif\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      drawing.width, drawing.height);
  for (const DrawnArea& area : drawing.areas) svg += area_svg(area);
  for (const DrawnLine& line : drawing.lines)
    svg += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#{:06x}\" stroke-width=\"{}\" "
        "stroke-linejoin=\"round\"{}/>\n",
        point_list(line.points), line.colour, line.width,
        line.dashed ? " stroke-dasharray=\"6 4\"" : "");
  for (const DrawnArea& area : drawing.marks) svg += area_svg(area);
  for (const DrawnText& text : drawing.texts) {
    const std::string turn = text.upwards ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"",
                                                        text.place.x(), text.place.y())
                                          : std::string();
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\" "
        "fill=\"#{:06x}\"{}>{}</text>\n",
        text.place.x(), text.place.y(), text.size, anchor_name(text.anchor), text.colour, turn,
        escaped(text.text));
  }
  return svg + "</svg>\n";
}

}  // namespace halfshade::detail
