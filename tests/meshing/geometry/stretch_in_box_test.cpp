#include "meshing/geometry/stretch_in_box.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const Vec2 low(0, 0), high(2, 1);

TEST(StretchInBox, IsWhereASegmentLiesInIt) {
  EXPECT_EQ(stretch_in_box({-1, 0.5}, {3, 0.5}, low, high), std::pair(0.25, 0.75));
  EXPECT_EQ(stretch_in_box({1, 0.5}, {1, 0.75}, low, high), std::pair(0., 1.));
  EXPECT_EQ(stretch_in_box({1, 0.5}, {1, 2.5}, low, high), std::pair(0., 0.25));
  EXPECT_EQ(stretch_in_box({1, 2.5}, {1, 0.5}, low, high), std::pair(0.75, 1.));
  EXPECT_EQ(stretch_in_box({-1, 1}, {1, -1}, low, high), std::pair(0.5, 0.5)) << "its corner";
}

TEST(StretchInBox, IsNothingBesideIt) {
  EXPECT_FALSE(stretch_in_box({-1, 2}, {3, 2}, low, high));
  EXPECT_FALSE(stretch_in_box({-1, 0.5}, {1, -1}, low, high)) << "past its corner";
  EXPECT_FALSE(stretch_in_box({3, 0.5}, {5, 0.5}, low, high)) << "before it begins";
}

}  // namespace
}  // namespace halfshade
