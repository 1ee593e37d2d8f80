#include "solver/pipeline/limits.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(Limits, FollowTheSceneUnlessTheyAreGiven) {
  EXPECT_EQ(with_limits({}, 5).max_elements, 40000);
  EXPECT_EQ(with_limits({}, 5).max_unknowns, 1000000);
  EXPECT_EQ(with_limits({}, 1000).max_elements, 400000);
  EXPECT_EQ(with_limits({}, 50000).max_elements, 1000000);
  EXPECT_EQ(with_limits({}, 50000).max_unknowns, 4000000);
  EXPECT_EQ(with_limits({}, 300000).max_elements, 4800000);
  EXPECT_EQ(with_limits({}, 3000000).max_elements, 10000000);
  SolveOptions given;
  given.max_elements = 70;
  given.max_unknowns = 90;
  EXPECT_EQ(with_limits(given, 5000).max_elements, 70);
  EXPECT_EQ(with_limits(given, 5000).max_unknowns, 90);
}

TEST(Limits, OfTheMatrixDoNotGrow) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  EXPECT_EQ(with_limits(options, 5000).max_elements, 40000);
}

}  // namespace
}  // namespace halfshade
