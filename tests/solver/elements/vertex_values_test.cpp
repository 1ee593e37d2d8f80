#include "solver/elements/vertex_values.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A fan of two triangles of areas 1 and 3 that share an edge, and one apart.
ElementTable fan() {
  ElementTable e;
  e.points = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {-6, 0, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  e.corners = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  e.area = {1, 3, 0.5};
  return e;
}

TEST(ValuesAtPoints, AreAreaWeightedMeansOfTheElementsAround) {
  ChannelArray values(3, 3);
  values << 4, 8, 12, 0, 4, -4, 7, 7, 7;
  const ChannelArray at_points = values_at_points(fan(), values);
  ASSERT_EQ(at_points.rows(), 7);
  for (const int shared : {0, 2}) {
    EXPECT_DOUBLE_EQ(at_points(shared, 0), 1);  // (1·4 + 3·0) / 4
    EXPECT_DOUBLE_EQ(at_points(shared, 1), 5);
    EXPECT_DOUBLE_EQ(at_points(shared, 2), 0);
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_DOUBLE_EQ(at_points(1, c), values(0, c));
    EXPECT_DOUBLE_EQ(at_points(3, c), values(1, c));
    EXPECT_DOUBLE_EQ(at_points(5, c), 7) << "nothing comes over from elements that share no point";
  }
}

TEST(ValuesAtPoints, KeepAConstant) {
  const ChannelArray at_points = values_at_points(fan(), ChannelArray::Constant(3, 3, 0.3));
  EXPECT_TRUE(at_points.isApproxToConstant(0.3, 1e-15));
}

TEST(ValuesAtPoints, APointWithoutElementsHasNoLight) {
  ElementTable e = fan();
  e.points.emplace_back(9, 9, 9);
  const ChannelArray at_points = values_at_points(e, ChannelArray::Ones(3, 3));
  EXPECT_TRUE(at_points.allFinite());
  EXPECT_EQ(at_points.row(7).maxCoeff(), 0);
}

TEST(ValuesAtPoints, OfNothingAreNothing) {
  EXPECT_EQ(values_at_points({}, ChannelArray(0, 3)).rows(), 0);
}

}  // namespace
}  // namespace halfshade
