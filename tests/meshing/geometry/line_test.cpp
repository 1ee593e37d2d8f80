#include "meshing/geometry/line.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const Span3 span = {{1, 0, 2}, {4, 0, 2}};

TEST(Span, DistanceToItsLineCountsBeyondItsEnds) {
  EXPECT_EQ(distance_to_line({2, 3, 6}, span), 5);
  EXPECT_EQ(distance_to_line({-7, 3, 6}, span), 5);
  EXPECT_EQ(distance_to_line(span.at(0.3), span), 0);
}

TEST(Span, EndsAreThoseWithinTheSlack) {
  EXPECT_TRUE(is_end({1, 0, 2}, span, 0));
  EXPECT_TRUE(is_end({4, 0.5, 2}, span, 0.5));
  EXPECT_FALSE(is_end({4, 0.5, 2}, span, 0.4));
  EXPECT_FALSE(is_end(span.at(0.5), span, 0.4));
}

}  // namespace
}  // namespace halfshade
