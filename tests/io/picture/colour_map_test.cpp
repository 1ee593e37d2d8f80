#include "io/picture/colour_map.h"

#include "io/picture/tone_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

/// CIELAB of a linear sRGB colour, white D65 (CIE 15; IEC 61966-2-1).
Vec3 lab(const Rgb& c) {
  const Vec3 xyz((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505,
                 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2],
                 (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  const Vec3 f =
      xyz.unaryExpr([](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16. / 116; });
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

void expect_colour(const ColourTable& table, double share, const std::array<int, 3>& expected,
                   int allowed) {
  const auto bytes = encode_srgb(table.at(share));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(bytes[c], expected[c], allowed) << share;
}

TEST(ColourMap, HasThePublishedColoursOfViridisAlsoBetweenThoseItIsMadeOf) {
  const ColourTable table(ColourMap::sequential);
  expect_colour(table, 0, {0x44, 0x01, 0x54}, 0);
  expect_colour(table, 1, {0xfd, 0xe7, 0x25}, 0);
  expect_colour(table, 0.5, {0x21, 0x90, 0x8c}, 0);
  // Not among them.
  expect_colour(table, 1. / 6, {0x44, 0x3a, 0x83}, 3);
  expect_colour(table, 5. / 6, {0x8f, 0xd7, 0x44}, 5);
}

TEST(ColourMap, EqualStepsLookAlikeAndLightnessRises) {
  const ColourTable table(ColourMap::sequential);
  constexpr int steps = 20;
  std::vector<double> lightness;
  double shortest = 1e9, longest = 0;
  for (int k = 0; k <= steps; ++k) {
    const Vec3 here = lab(table.at(k / double(steps)));
    if (k > 0) {
      const double rise = here[0] - lightness.back();
      EXPECT_GT(rise, 2) << k;
      EXPECT_LT(rise, 6) << k;
      const double length = (here - lab(table.at((k - 1) / double(steps)))).norm();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    lightness.push_back(here[0]);
  }
  // Even in CAM02-UCS, where viridis was made; CIELAB stretches saturated colours.
  EXPECT_LT(longest, 3 * shortest);
}

TEST(ColourMap, DifferencesAreGreyInTheMiddleAndAsDarkAtEitherEnd) {
  const ColourTable table(ColourMap::diverging);
  expect_colour(table, 0, {59, 76, 192}, 0);
  expect_colour(table, 0.5, {221, 221, 221}, 1);
  expect_colour(table, 1, {180, 4, 38}, 0);
  for (int k = 1; k <= 10; ++k) {
    EXPECT_LT(lab(table.at(0.5 - k / 20.))[0], lab(table.at(0.5 - (k - 1) / 20.))[0]);
    EXPECT_LT(lab(table.at(0.5 + k / 20.))[0], lab(table.at(0.5 + (k - 1) / 20.))[0]);
    EXPECT_NEAR(lab(table.at(0.5 - k / 20.))[0], lab(table.at(0.5 + k / 20.))[0], 3);
  }
}

TEST(ColourMap, WhatIsOutsideHasTheColourOfTheEndAndNoNumberIsGrey) {
  const ColourTable table(ColourMap::sequential);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE((table.at(-infinity) == table.at(0)).all());
  EXPECT_TRUE((table.at(1.5) == table.at(1)).all());
  const Rgb grey = table.at(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(grey[0], grey[1]);
  EXPECT_EQ(grey[1], grey[2]);
}

}  // namespace
}  // namespace halfshade
