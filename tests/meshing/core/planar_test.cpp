#include "meshing/core/planar.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

// A square of side 4 with a square hole of side 2 in its middle.
const std::vector<std::vector<Vec2>> frame = {{{0, 0}, {4, 0}, {4, 4}, {0, 4}},
                                              {{1, 1}, {1, 3}, {3, 3}, {3, 1}}};

TEST(Planar, HolesAreNotInside) {
  EXPECT_TRUE(is_inside(frame, {0.5, 2}));
  EXPECT_TRUE(is_inside(frame, {3.5, 3.5}));
  EXPECT_FALSE(is_inside(frame, {2, 2}));
  EXPECT_FALSE(is_inside(frame, {-0.5, 2}));
  EXPECT_FALSE(is_inside(frame, {4.5, 1}));
}

TEST(Planar, InsideCoversTheArea) {
  int inside = 0;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) inside += is_inside(frame, {0.04 * i + 0.02, 0.04 * j + 0.02});
  EXPECT_EQ(inside, 7500);
}

TEST(Planar, DistanceIsToTheNearestPartOfASegment) {
  EXPECT_DOUBLE_EQ(distance_to_segment({1, 2}, {0, 0}, {3, 0}), 2);
  EXPECT_DOUBLE_EQ(distance_to_segment({6, 4}, {0, 0}, {3, 0}), 5);
  EXPECT_DOUBLE_EQ(distance_to_segment({-3, -4}, {0, 0}, {3, 0}), 5);
  EXPECT_DOUBLE_EQ(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5);
}

TEST(Planar, NearestOnASegmentIsAParameterOfIt) {
  EXPECT_EQ(nearest_on_segment({0.75, 2}, {0, 0}, {3, 0}), 0.25);
  EXPECT_EQ(nearest_on_segment({-3, -4}, {0, 0}, {3, 0}), 0);
  EXPECT_EQ(nearest_on_segment({6, 4}, {0, 0}, {3, 0}), 1);
  EXPECT_EQ(nearest_on_segment({3, 4}, {0, 0}, {0, 0}), 0);
}

TEST(Planar, DistanceIsToTheNearestRing) {
  EXPECT_DOUBLE_EQ(distance_to_rings(frame, {2, 2}), 1);
  EXPECT_DOUBLE_EQ(distance_to_rings(frame, {0.25, 2}), 0.25);
  EXPECT_DOUBLE_EQ(distance_to_rings(frame, {7, 8}), 5);
}

TEST(Planar, CrossIsTwiceTheSignedArea) {
  EXPECT_EQ(cross_2d({2, 0}, {1, 3}), 6);
  EXPECT_EQ(cross_2d({1, 3}, {2, 0}), -6);
}

}  // namespace
}  // namespace halfshade
