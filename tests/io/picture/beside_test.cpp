#include "io/picture/picture.h"
#include "tests/support/drawn_squares.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

Picture plain(int width, int height, std::uint8_t grey) {
  return {width, height, 0.5,
          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), grey), "c"};
}

TEST(Beside, PicturesStandInTheirOrderUnchanged) {
  const std::array pictures = {plain(30, 50, 10), plain(20, 50, 200)};
  const std::array<std::string, 2> titles = {"", ""};
  const Picture both = beside(pictures, titles);
  EXPECT_EQ(both.width, 50);
  EXPECT_EQ(both.height, 50);
  EXPECT_EQ(both.exposure, 0.5);
  EXPECT_EQ(both.comment, "c");
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 50; ++x)
      EXPECT_EQ(test::pixel_of(both, x, y)[1], x < 30 ? 10 : 200) << x << ' ' << y;
}

TEST(Beside, EachTitleIsInItsPicturesUpperLeftCorner) {
  const std::array pictures = {plain(200, 200, 100), plain(200, 200, 100)};
  const std::array<std::string, 2> titles = {"", "other.vtu"};
  const Picture both = beside(pictures, titles);
  int bright = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 400; ++x) {
      const int grey = test::pixel_of(both, x, y)[1];
      if (grey == 100) continue;
      EXPECT_GE(x, 200);
      EXPECT_LT(y, 20);
      bright += grey > 180;
    }
  EXPECT_GT(bright, 30);
}

TEST(Beside, HeightsAndTitlesMustFit) {
  const std::array<std::string, 2> titles = {"a", "b"};
  test::expect_error(
      [&] {
        beside(std::array{plain(5, 5, 0), plain(5, 6, 0)}, titles);
      },
      ErrorCode::contract, {"height"});
  test::expect_error([&] { beside(std::array{plain(5, 5, 0)}, titles); }, ErrorCode::contract,
                     {"title"});
}

}  // namespace
}  // namespace halfshade
