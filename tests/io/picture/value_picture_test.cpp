#include "io/picture/value_picture.h"

#include "io/picture/colour_map.h"
#include "io/picture/tone_map.h"
#include "tests/support/drawn_squares.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

using test::add_square, test::facing, test::picture_options, test::Pixel, test::pixel_of;

Pixel colour_at(double share, ColourMap map = ColourMap::sequential) {
  const auto bytes = encode_srgb(ColourTable(map).at(share));
  return {bytes[0], bytes[1], bytes[2]};
}

ValueMesh values(std::string name = "irradiance") {
  return {{}, {std::move(name), "", "W/m²", false}};
}

/// A square that carries `left` at its left corners and `right` at the others, and fills the
/// picture of facing().
ValueMesh ramp(double left, double right) {
  ValueMesh result = values();
  add_square(result.mesh, Vec3::Zero(), 1, Rgb::Constant((left + right) / 2));
  for (std::size_t k = 0; k < 4; ++k)
    result.mesh.point_value[k] = Rgb::Constant(result.mesh.points[k].x() < 0 ? left : right);
  return result;
}

TEST(DrawValues, ColoursSayWhereInTheRangeAValueLies) {
  const ValuePicture drawn = draw_values(ramp(0, 4), facing(), picture_options(40, 40, 1));
  EXPECT_EQ(drawn.range.low, 0);
  EXPECT_NEAR(drawn.range.high, 4 * 39.5 / 40, 1e-9) << "the highest that pixels see";
  EXPECT_GT(drawn.picture.width, 40) << "the legend stands beside";
  EXPECT_EQ(drawn.picture.height, 40);
  for (const int column : {0, 7, 20, 33, 39}) {
    const double value = 4 * (column + 0.5) / 40;
    EXPECT_EQ(pixel_of(drawn.picture, column, 11), colour_at(value / drawn.range.high)) << column;
  }
}

TEST(DrawValues, ALogarithmicScaleSpreadsWhatIsSmall) {
  ValuePictureOptions how;
  how.scale = ValueScale::log;
  how.range = ValueRange{0.01, 100};
  for (const auto& [value, share] :
       {std::pair{0.1, 0.25}, {1., 0.5}, {100., 1.}, {1e-9, 0.}, {0., 0.}, {-1., 0.}, {1e9, 1.}}) {
    const ValuePicture drawn =
        draw_values(ramp(value, value), facing(), picture_options(20, 20, 1), how);
    EXPECT_EQ(pixel_of(drawn.picture, 5, 5), colour_at(share)) << value;
    EXPECT_EQ(drawn.range.low, 0.01);
  }
}

TEST(DrawValues, EmittersDoNotStretchTheRange) {
  ValueMesh mesh = ramp(1, 2);
  add_square(mesh.mesh, {0, 0, 0.1}, 0.3, Rgb::Constant(500), true);
  const ValuePicture drawn = draw_values(mesh, facing(), picture_options(40, 40, 1));
  EXPECT_LE(drawn.range.high, 2);
  EXPECT_EQ(pixel_of(drawn.picture, 20, 20), colour_at(1));
}

TEST(DrawValues, WhereNothingElseIsEmittersMakeTheRange) {
  ValueMesh mesh = ramp(0, 0);
  add_square(mesh.mesh, {0, 0, 0.1}, 0.3, Rgb::Constant(500), true);
  EXPECT_NEAR(draw_values(mesh, facing(), picture_options(40, 40, 1)).range.high, 500, 1e-9);
}

TEST(DrawValues, CodesHaveARangeFromTheFirstToTheLast) {
  ValueMesh mesh = values("region");
  mesh.quantity.is_whole = true;
  add_square(mesh.mesh, {-0.5, 0, 0}, 0.4, Rgb::Constant(3));
  add_square(mesh.mesh, {0.5, 0, 0}, 0.4, Rgb::Constant(1));
  mesh.mesh.point_value.clear();
  const ValuePicture drawn = draw_values(mesh, facing(), picture_options(40, 40, 1));
  EXPECT_EQ(drawn.range.low, 1);
  EXPECT_EQ(drawn.range.high, 3);
  EXPECT_EQ(pixel_of(drawn.picture, 10, 20), colour_at(1));
  EXPECT_EQ(pixel_of(drawn.picture, 30, 20), colour_at(0));
  EXPECT_EQ(pixel_of(drawn.picture, 20, 20), test::picture_background);
}

TEST(DrawValues, TheLegendHasTheColoursInOrderAndInk) {
  const ValuePicture drawn = draw_values(ramp(0, 4), facing(), picture_options(300, 300, 1));
  const Picture& picture = drawn.picture;
  // The middle of the bar: 9 pixel font, margin 0.8, half of 1.4.
  const int x = 300 + 14;
  int yellow = -1, teal = -1, purple = -1, inked = 0;
  for (int y = 0; y < 300; ++y) {
    const Pixel p = pixel_of(picture, x, y);
    const auto is_like = [&](double share) {
      const Pixel q = colour_at(share);
      return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) < 6;
    };
    if (is_like(0.995)) yellow = y;
    if (is_like(0.5)) teal = y;
    if (is_like(0.005)) purple = y;
    for (int column = x + 10; column < picture.width; ++column)
      inked += pixel_of(picture, column, y)[0] > 150;
  }
  EXPECT_GT(yellow, 0);
  EXPECT_NEAR(teal, (yellow + purple) / 2., 5);
  EXPECT_GT(purple, teal);
  EXPECT_GT(inked, 100) << "numbers";
}

TEST(DrawValues, TheLegendSaysThatValuesLieBeyondItsEnds) {
  ValuePictureOptions how;
  const auto end_rows = [&](double low, double high) {
    how.range = ValueRange{low, high};
    const Picture picture =
        draw_values(ramp(1, 2), facing(), picture_options(300, 300, 1), how).picture;
    int rows = 0;
    for (int y = 0; y < 300; ++y)
      rows += pixel_of(picture, 300 + 14, y) != test::picture_background;
    return rows;
  };
  const int within = end_rows(0, 3), above = end_rows(0, 1.5), both = end_rows(1.2, 1.5);
  EXPECT_GT(above, within + 2);
  EXPECT_GT(both, above + 2);
}

TEST(DrawValues, APictureTooSmallForALegendIsDrawnAllTheSame) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {20, 1}, {1, 20}}) {
    const ValuePicture drawn = draw_values(ramp(0, 1), facing(), picture_options(width, height, 1));
    EXPECT_EQ(drawn.picture.height, height);
  }
}

TEST(DrawValues, ARangeThatIsNoneIsRefused) {
  for (const ValueRange range : {ValueRange{1, 1}, {2, 1}, {0, NAN}, {-INFINITY, 0}}) {
    ValuePictureOptions how;
    how.range = range;
    test::expect_error([&] { draw_values(ramp(0, 1), facing(), picture_options(5, 5), how); },
                       ErrorCode::contract, {"range"});
  }
  ValuePictureOptions how;
  how.scale = ValueScale::log;
  how.range = ValueRange{0, 1};
  test::expect_error([&] { draw_values(ramp(0, 1), facing(), picture_options(5, 5), how); },
                     ErrorCode::contract, {"above zero"});
}

TEST(DrawDifference, OfTheSameIsGreyAndZero) {
  const ValuePicture drawn =
      draw_difference(ramp(1, 3), ramp(1, 3), facing(), picture_options(30, 30, 1));
  EXPECT_EQ(drawn.difference.rms, 0);
  EXPECT_EQ(drawn.difference.largest, 0);
  EXPECT_EQ(pixel_of(drawn.picture, 8, 8), colour_at(0.5, ColourMap::diverging));
}

TEST(DrawDifference, IsOneMinusTheOtherAlsoOnAnotherMesh) {
  // 1 + x against 2 − x/2 on four squares: −1 + 3x/2, from −2.5 to 0.5.
  ValueMesh other = values();
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5}) add_square(other.mesh, {x, y, 0}, 0.5, Rgb::Constant(2));
  for (std::size_t k = 0; k < other.mesh.points.size(); ++k)
    other.mesh.point_value[k] = Rgb::Constant(2 - other.mesh.points[k].x() / 2);
  const ValuePicture drawn =
      draw_difference(ramp(0, 2), other, facing(), picture_options(60, 60, 1));
  EXPECT_NEAR(drawn.difference.mean, -1, 1e-9);
  EXPECT_NEAR(drawn.difference.largest, 2.5, 0.03);
  EXPECT_NEAR(drawn.difference.rms, std::sqrt(1 + 9. / 4 / 3), 1e-3);
  EXPECT_NEAR(drawn.difference.relative, std::sqrt((1 + 9. / 12) / (4 + 1. / 12)), 1e-3);
  EXPECT_DOUBLE_EQ(drawn.range.low, -drawn.range.high);
  for (const int column : {1, 25, 44, 58}) {
    const double value = -1 + 1.5 * ((column + 0.5) / 30 - 1);
    EXPECT_EQ(pixel_of(drawn.picture, column, 40),
              colour_at(share_in(drawn.range, ValueScale::linear, value), ColourMap::diverging))
        << column;
  }
}

TEST(DrawDifference, OfOtherGeometryIsRefused) {
  ValueMesh larger = values();
  add_square(larger.mesh, Vec3::Zero(), 2, Rgb::Constant(1));
  test::expect_error([&] { draw_difference(ramp(0, 1), larger, facing(), picture_options(9, 9)); },
                     ErrorCode::invalid_input, {"same scene", "4", "16"});
  ValueMesh moved = values();
  add_square(moved.mesh, {0, 0, -0.5}, 1, Rgb::Constant(1));
  test::expect_error([&] { draw_difference(ramp(0, 1), moved, facing(), picture_options(9, 9)); },
                     ErrorCode::invalid_input, {"same scene", "elsewhere"});
}

TEST(DrawDifference, HasNoLogarithmicScale) {
  ValuePictureOptions how;
  how.scale = ValueScale::log;
  test::expect_error(
      [&] { draw_difference(ramp(0, 1), ramp(0, 1), facing(), picture_options(9, 9), how); },
      ErrorCode::contract, {"logarithmic"});
}

}  // namespace
}  // namespace halfshade
