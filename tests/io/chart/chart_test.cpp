#include "io/chart/chart.h"

#include "io/chart/drawing.h"
#include "io/picture/log_axis.h"
#include "tests/support/expect_error.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace halfshade {
namespace {

using testing::HasSubstr;
using testing::Not;

Chart some_chart() {
  Chart chart;
  chart.title = "Error & time <s>";
  chart.x_label = "run time, s";
  chart.y_label = "error";
  chart.series = {{"first", {{0.1, 0.1}, {1, 0.01}, {10, 0.001}}},
                  {"second", {{0.2, 0.3}, {0, 0.1}, {std::nan(""), 1}, {3, 0.03}}}};
  return chart;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
    ++found;
  return found;
}

TEST(LogAxis, PutsPowersOfTenAtEvenDistances) {
  const detail::LogAxis axis = detail::fitting_axis({0.01, 100}, 50, 450);
  EXPECT_GT(axis.at(0.01), 50);
  EXPECT_LT(axis.at(100), 450);
  EXPECT_NEAR(axis.at(1), 250, 1e-9);
  EXPECT_NEAR(axis.at(10) - axis.at(1), axis.at(0.1) - axis.at(0.01), 1e-9);
  std::vector<std::string> labels;
  for (const detail::Tick& tick : detail::ticks(axis))
    if (!tick.label.empty()) labels.push_back(tick.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
}

TEST(LogAxis, LabelsShortAndLongOnes) {
  const auto labels = [](double low, double high) {
    std::vector<std::string> result;
    for (const detail::Tick& tick : detail::ticks(detail::fitting_axis({low, high}, 0, 1)))
      if (!tick.label.empty()) result.push_back(tick.label);
    return result;
  };
  EXPECT_EQ(labels(2, 4), (std::vector<std::string>{"1", "2", "5"}));
  EXPECT_EQ(labels(1e-9, 1), (std::vector<std::string>{"1e-8", "1e-6", "1e-4", "0.01", "1"}));
  EXPECT_GE(labels(7, 7).size(), 1u) << "one value only";
  EXPECT_GE(detail::ticks(detail::fitting_axis({}, 0, 1)).size(), 1u) << "none";
}

TEST(Chart, HoldsEverythingAsText) {
  const std::string svg = chart_svg(some_chart());
  for (const char* part : {"Error &amp; time &lt;s>", "run time, s", ">error<", ">first<",
                           ">second<", ">0.1<", ">0.001<", ">10<"})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_EQ(count(svg, "<polygon"), 3u + 2 + 2) << "marks: what has no logarithm is left out";
  EXPECT_EQ(count(svg, "<text"), count(svg, "</text>"));
}

TEST(Chart, CanHaveNoPointsAtAll) {
  Chart chart = some_chart();
  chart.series = {{"none", {}}};
  EXPECT_THAT(chart_svg(chart), HasSubstr(">none<"));
  chart.series.clear();
  chart.equal_line = true;
  chart.unknown_below = 1e-3;
  EXPECT_THAT(chart_svg(chart), Not(HasSubstr("nan")));
}

TEST(Chart, DrawsPixelsWithoutADisplay) {
  detail::Drawing drawing;
  drawing.width = 40;
  drawing.height = 30;
  drawing.marks.push_back({{{10, 10}, {20, 10}, {20, 20}, {10, 20}}, 0xd55e00});
  drawing.lines.push_back({{{0, 25}, {40, 25}}, 2, 0x0072b2});
  const auto pixels = detail::drawing_pixels(drawing, 2);
  ASSERT_EQ(pixels.size(), 80u * 60 * 3);
  const auto colour = [&](std::size_t x, std::size_t y) {
    const std::size_t k = 3 * (80 * y + x);
    return pixels[k] << 16 | pixels[k + 1] << 8 | pixels[k + 2];
  };
  EXPECT_EQ(colour(30, 30), 0xd55e00);
  EXPECT_EQ(colour(22, 22), 0xd55e00);
  EXPECT_EQ(colour(18, 30), 0xffffff);
  EXPECT_EQ(colour(60, 50), 0x0072b2);
  drawing.texts.push_back({{2, 15}, "Hi", 12});
  const auto with_text = detail::drawing_pixels(drawing, 2);
  EXPECT_NE(with_text, pixels);
  EXPECT_EQ(with_text, detail::drawing_pixels(drawing, 2));
}

TEST(Chart, IsWrittenByExtension) {
  const test::TempDir folder;
  write_chart(some_chart(), folder.path() / "a.svg");
  EXPECT_EQ(test::contents(folder.path() / "a.svg"), chart_svg(some_chart()));
  write_chart(some_chart(), folder.path() / "a.png");
  EXPECT_EQ(test::contents(folder.path() / "a.png").substr(1, 3), "PNG");
  test::expect_error([&] { write_chart(some_chart(), folder.path() / "a.pdf"); }, ErrorCode::usage,
                     {".svg", ".png"});
  test::expect_error([&] { write_chart(some_chart(), folder.path() / "none" / "a.svg"); },
                     ErrorCode::unwritable, {"a.svg"});
}

}  // namespace
}  // namespace halfshade
