#include "io/picture/curve_picture.h"

#include "io/picture/line_canvas.h"
#include "io/picture/tone_map.h"
#include "tests/support/expect_error.h"
#include "tests/support/hand_made_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

using Bytes = std::array<std::uint8_t, 3>;

Bytes pixel(const Picture& picture, int x, int y) {
  const auto k = static_cast<std::size_t>(y * picture.width + x) * 3;
  return {picture.pixels.at(k), picture.pixels.at(k + 1), picture.pixels.at(k + 2)};
}

bool is_grey(const Bytes& p) {
  return std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) < 6;
}

bool is_like(const Bytes& p, const Bytes& colour) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(p[c] - colour[c]) > 40) return false;
  return true;
}

/// The floor of S1 in a picture: x to the right, y upwards, in world coordinates.
class CurvePicture : public testing::Test {
 protected:
  static constexpr double centre = -0.0379, side = 3.7984;
  static constexpr int pixels = 400;

  Picture drawn(const CurvePictureOptions& given = {}) const {
    CurvePictureOptions options = given;
    options.pixels = pixels;
    const std::vector<int> floor = {2};
    return draw_curves(scene_, DirectLightIndex(scene_), found_, floor, options);
  }
  /// The pixel where a point of the floor in its frame's coordinates is.
  static Bytes at(const Picture& picture, const SoundScene& scene, const Vec2& q) {
    const Vec3 p = scene.surfaces[2].frame.to_space(q);
    const double scale = pixels / (1.04 * side);
    return pixel(picture, static_cast<int>(pixels / 2. + (p.x() - centre) * scale),
                 static_cast<int>(pixels / 2. - (p.y() - centre) * scale));
  }

  const SoundScene scene_ = test::s1();
  const Discontinuities found_ = test::hand_made_curves();
};

TEST_F(CurvePicture, LinesHaveTheirColourWhereTheyLie) {
  CurvePictureOptions options;
  options.line_width = 3;  // the pixel that a point falls into is covered wholly
  const Picture by_order = drawn(options);
  options.colour = CurveColour::kind;
  const Picture by_kind = drawn(options);
  int on_curves = 0;
  for (const DiscontinuityCurve& curve : found_.curves)
    for (const double s : {0.1, 0.3, 0.5, 0.8, 0.9}) {
      const Vec2 q = point_at(curve.arc, s);
      EXPECT_TRUE(is_like(at(by_order, scene_, q), curve_colour(curve, CurveColour::order)));
      EXPECT_TRUE(is_like(at(by_kind, scene_, q), curve_colour(curve, CurveColour::kind)));
      ++on_curves;
    }
  EXPECT_EQ(on_curves, 15);
  const auto& line = found_.curves[0];
  EXPECT_NE(curve_colour(line, CurveColour::order), curve_colour(line, CurveColour::kind))
      << "an EV line of order 1 is blue by order and pink by kind";
}

TEST_F(CurvePicture, OnlyLinesAreColoured) {
  const Picture picture = drawn();
  EXPECT_EQ(picture.width, pixels);
  EXPECT_EQ(picture.height, pixels);
  const double pixel_size = 1.04 * side / pixels;
  int coloured = 0;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      if (is_grey(pixel(picture, x, y))) continue;
      ++coloured;
      const Vec3 p(centre + (x + 0.5 - pixels / 2.) * pixel_size,
                   centre - (y + 0.5 - pixels / 2.) * pixel_size, 0);
      const Vec2 q = scene_.surfaces[2].frame.to_plane(p);
      double nearest = 1e9;
      for (const DiscontinuityCurve& curve : found_.curves)
        nearest = std::min(nearest, distance(curve.arc, q));
      EXPECT_LT(nearest, 1.3 * pixel_size) << x << ' ' << y;
    }
  // Length × width: about (1 + π/2 + 0.75) / pixel_size × 1.5, soft edges counted in full.
  EXPECT_GT(coloured, 3.3 / pixel_size * 1.4);
  EXPECT_LT(coloured, 3.3 / pixel_size * 3);
}

TEST_F(CurvePicture, TheGroundIsTheExactLight) {
  Discontinuities none;
  const std::vector<int> floor = {2};
  const Picture picture = draw_curves(scene_, DirectLightIndex(scene_), none, floor, {});
  const auto grey = [&](double x, double y) {
    const double scale = 500 / (1.04 * side);
    return int{pixel(picture, static_cast<int>(250 + (x - centre) * scale),
                     static_cast<int>(250 - (y - centre) * scale))[0]};
  };
  // Umbra |x|, |y| < 0.25, equally dark all over; brightest at the rim of the penumbra.
  EXPECT_EQ(grey(0, 0), grey(0.2, -0.2));
  EXPECT_LT(grey(0.2, 0), grey(0.4, 0));
  EXPECT_LT(grey(0.4, 0), grey(0.7, 0));
  EXPECT_GT(grey(1.1, 0), grey(1.8, 0));
  EXPECT_EQ(grey(0.7, 0), grey(-0.7, 0)) << "the light is symmetric";
  // Irradiance at (0.5, 0) and (1, 0) relative to each other, as roots of shares of the whitest.
  EXPECT_GT(picture.exposure, 0);
  const double dark = grey(0, 0);
  const double h = 0.040681704379;  // at (1.25, 0), from data/s1_points.csv
  EXPECT_NEAR(grey(1.25, 0), dark + 165 * std::sqrt(h * picture.exposure), 2);
}

TEST_F(CurvePicture, UpIsWhereTheCallerWantsIt) {
  CurvePictureOptions options;
  const Picture upright = drawn();
  options.up = {0, -1, 0.3};
  const Picture turned = drawn(options);
  // Half a turn.
  std::vector<std::uint8_t> reversed;
  for (std::size_t k = turned.pixels.size() / 3; k-- > 0;)
    reversed.insert(reversed.end(), turned.pixels.begin() + static_cast<std::ptrdiff_t>(3 * k),
                    turned.pixels.begin() + static_cast<std::ptrdiff_t>(3 * k + 3));
  int different = 0;
  for (std::size_t k = 0; k < reversed.size(); ++k)
    different += std::abs(reversed[k] - upright.pixels[k]) > 8;
  EXPECT_LT(different, 100);
  EXPECT_NE(turned.pixels, upright.pixels);
}

TEST_F(CurvePicture, ALongSurfaceMakesALongPicture) {
  SoundScene scene = test::empty_sound_scene(5);
  test::add_surface(scene, {{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}}}, 0);
  test::add_surface(scene, {{{1, 0, 1}, {1, 1, 1}, {2, 1, 1}}}, 1);
  const std::vector<int> floor = {0};
  const Picture picture = draw_curves(scene, DirectLightIndex(scene), {}, floor, {.pixels = 208});
  EXPECT_EQ(picture.width, 208);
  EXPECT_EQ(picture.height, 58);  // 200 pixels are 4 units; 50 + 2 × 4
}

TEST(PictureSurfaces, AreFoundByNameNumberOrCurves) {
  SoundScene scene = test::s1();
  scene.groups = {"rest", "floor"};
  scene.surfaces[2].group = 1;
  const Discontinuities found = test::hand_made_curves();
  EXPECT_EQ(picture_surfaces(scene, found, ""), std::vector<int>{2});
  EXPECT_EQ(picture_surfaces(scene, found, "floor"), std::vector<int>{2});
  EXPECT_EQ(picture_surfaces(scene, found, "1"), std::vector<int>{1});
  test::expect_error([&] { picture_surfaces(scene, found, "rest"); }, ErrorCode::usage,
                     {"rest", "several planes"});
  for (const char* name : {"roof", "3", "-1", "1x", "99999999999999999999"})
    test::expect_error([&] { picture_surfaces(scene, found, name); }, ErrorCode::usage,
                       {name, "rest, floor", "0 to 2"});
  test::expect_error([&] { picture_surfaces(scene, {}, ""); }, ErrorCode::usage, {"no curves"});
}

TEST(DrawCurves, RefusesWhatItCannotDraw) {
  const SoundScene scene = test::s1();
  const DirectLightIndex light(scene);
  const std::vector<int> none, floor = {2}, two = {1, 2}, wrong = {3};
  for (const auto& [surfaces, options] : {std::pair(none, CurvePictureOptions{}),
                                          {two, CurvePictureOptions{}},
                                          {wrong, CurvePictureOptions{}},
                                          {floor, CurvePictureOptions{.pixels = 15}},
                                          {floor, CurvePictureOptions{.line_width = 0}}})
    test::expect_error([&, &r = surfaces, &o = options] { draw_curves(scene, light, {}, r, o); },
                       ErrorCode::contract, {"draw_curves"});
}

TEST(DrawCurves, StopsWithAPictureOfTheRightSize) {
  std::stop_source stop;
  stop.request_stop();
  const std::vector<int> floor = {2};
  const SoundScene scene = test::s1();
  const Picture picture =
      draw_curves(scene, DirectLightIndex(scene), {}, floor, {}, {stop.get_token(), {}});
  EXPECT_EQ(picture.pixels.size(), static_cast<std::size_t>(3 * picture.width * picture.height));
}

TEST(LineCanvas, DecodesWhatItEncodes) {
  for (int byte = 0; byte < 256; ++byte) {
    const auto b = static_cast<std::uint8_t>(byte);
    EXPECT_EQ(encode_srgb(detail::decode_srgb({b, 0, 255})), (Bytes{b, 0, 255}));
  }
}

TEST(LineCanvas, CoversAsMuchAsTheLineIsLargeAndNothingTwice) {
  const auto coverage = [](const std::vector<Vec2>& points, double width) {
    detail::LineCanvas canvas(64, 48, Rgb::Zero());
    canvas.line(points, width, Rgb::Ones());
    double sum = 0;
    const auto bytes = canvas.bytes();
    for (std::size_t k = 0; k < bytes.size(); k += 3)
      sum += detail::decode_srgb({bytes[k], bytes[k + 1], bytes[k + 2]})[0];
    return sum;
  };
  for (const double width : {0.7, 1.5, 4.})
    for (const Vec2& end : {Vec2(50, 10), Vec2(50, 35.3), Vec2(12.2, 40), Vec2(10, 40)}) {
      const double length = (end - Vec2(10, 10)).norm();
      const double area = coverage({{10, 10}, end}, width);
      // Plus round ends.
      EXPECT_NEAR(area, width * length, width * (width + 1) + 0.03 * length) << end.transpose();
      EXPECT_NEAR(coverage({{10, 10}, end, {10, 10}}, width), area, 1e-9);
    }
  EXPECT_EQ(coverage({{-30, -20}, {-10, 100}}, 1.5), 0) << "outside";
  EXPECT_NEAR(coverage({{-30, 20}, {100, 20}}, 1.5), 64 * 1.5, 3) << "from side to side";
}

}  // namespace
}  // namespace halfshade
