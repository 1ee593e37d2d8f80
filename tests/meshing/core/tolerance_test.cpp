#include "meshing/core/tolerance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace halfshade {
namespace {

TEST(LocalTolerance, FollowsTheMagnitudeWhereFeaturesAreLarge) {
  const LocalTolerance tolerance = tolerance_of({4, 1});
  EXPECT_DOUBLE_EQ(tolerance.length, 4e-9);
  EXPECT_DOUBLE_EQ(tolerance.planarity, 4e-6);
}

TEST(LocalTolerance, MovesNothingByANoticeablePartOfItsSize) {
  for (const double magnitude : {1., 1e3, 1e6})
    for (const double size : {1e-9, 1e-6, 1e-3, 1.}) {
      const LocalTolerance tolerance = tolerance_of({magnitude, size});
      EXPECT_LE(tolerance.length, std::max(1e-6 * size, 2e-14 * magnitude));
      EXPECT_LE(tolerance.planarity, std::max(1e-3 * size, 2e-14 * magnitude));
      EXPECT_GE(tolerance.length, 1e-14 * magnitude) << "what doubles hold";
      EXPECT_GE(tolerance.planarity, tolerance.length);
    }
}

TEST(LocalTolerance, FollowsWhatDigitsTellIfThatIsCoarser) {
  EXPECT_DOUBLE_EQ(tolerance_of({4, 1, 1e-6}).planarity, 4e-6);
  EXPECT_DOUBLE_EQ(tolerance_of({4, 1, 2e-5}).planarity, 2e-5);
  EXPECT_DOUBLE_EQ(tolerance_of({4, 1, 2e-2}).planarity, 1e-3)
      << "not more than a share of the size";
  EXPECT_DOUBLE_EQ(tolerance_of({4, 1, 2e-2}).length, 4e-9) << "rounding parts no points";
}

TEST(LocalTolerance, ScalesExactlyWithPowersOfTwo) {
  const LocalTolerance one = tolerance_of({3.7, 0.011});
  for (const int k : {-90, -3, 7, 80}) {
    const LocalTolerance other = tolerance_of({std::ldexp(3.7, k), std::ldexp(0.011, k)});
    EXPECT_EQ(other.length, std::ldexp(one.length, k));
    EXPECT_EQ(other.planarity, std::ldexp(one.planarity, k));
  }
}

TEST(LocalScale, IsOfCornersAndOfTheSmallerThing) {
  const std::array<Vec3, 3> corners = {Vec3(1, -5, 2), Vec3(4, -5, 2), Vec3(1, -1, 2)};
  const LocalScale scale = scale_of(corners);
  EXPECT_DOUBLE_EQ(scale.magnitude, 5);
  EXPECT_DOUBLE_EQ(scale.size, 5);
  EXPECT_EQ(joint_scale({5, 1, 1e-6}, {2, 3, 1e-5}), (LocalScale{5, 1, 1e-5}));
}

}  // namespace
}  // namespace halfshade
