#include "meshing/geometry/collinear.h"

#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

using test::Random;

constexpr double tolerance = 1e-9;

TEST(CollinearGroups, AngleWrapsAroundAtHalfATurn) {
  // Directions a hair to both sides of each axis and diagonal, in both senses.
  for (int eighth = 0; eighth < 8; ++eighth) {
    std::vector<std::array<Vec2, 2>> segments;
    const double angle = eighth * std::numbers::pi / 4;
    for (const double off : {0.0, 2e-11, -2e-11, std::numbers::pi, std::numbers::pi - 2e-11}) {
      const Vec2 d(std::cos(angle + off), std::sin(angle + off));
      segments.push_back({Vec2(1, 1), Vec2(1, 1) + 10 * d});
      segments.push_back({Vec2(1, 1) + 3 * d, Vec2(1, 1) + 2 * d});
    }
    const std::vector<int> group = collinear_groups(segments, tolerance);
    for (const int g : group) EXPECT_EQ(g, group[0]) << eighth;
  }
}

TEST(CollinearGroups, AreThoseOfABruteForceSearch) {
  Random random(9);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::array<Vec2, 2>> segments;
    std::vector<int> line_of;
    for (int k = 0; k < 200; ++k) {
      const int line = static_cast<int>(random(0, 30));
      const double angle = std::fmod(line * 0.37, 3.2);
      const Vec2 d(std::cos(angle), std::sin(angle)), origin(line % 5, line % 7);
      const double a = random(-5, 5), size = std::pow(10, random(-3, 1));
      segments.push_back({origin + a * d, origin + (a + size) * d});
      line_of.push_back(line);
    }
    const std::vector<int> group = collinear_groups(segments, tolerance);
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(group[i] == group[j], line_of[i] == line_of[j]);
  }
}

}  // namespace
}  // namespace halfshade
