#include "meshing/repair/written_digits.h"

#include <gtest/gtest.h>

#include <vector>

namespace halfshade {
namespace {

WrittenDigits of(double x, double y) { return digits_of(std::vector<Vec3>{{x, y, 0}}); }

TEST(WrittenDigits, AreThoseOfTheLongestNumberAndTheFinestPlace) {
  EXPECT_EQ(of(12.3456, -0.5).most, 6);
  EXPECT_EQ(of(12.3456, -0.5).last_place, -4);
  EXPECT_EQ(of(1200, 0).last_place, 2);
  EXPECT_EQ(of(1e-6, 3).last_place, -6);
  EXPECT_EQ(of(1. / 3, 1).most, 16);
  EXPECT_TRUE(of(0.5, 3).is_single);
  EXPECT_TRUE(of(static_cast<double>(0.1F), 3).is_single);
  EXPECT_FALSE(of(0.1, 3).is_single);
}

TEST(WrittenDigits, OfSinglePrecisionMayBeNine) {
  EXPECT_TRUE(of(-3.61616349, 1.68233788).is_single);
  EXPECT_TRUE(of(0.100000001, 3.2913239).is_single);  // the ninth is 0
  EXPECT_FALSE(of(-3.61616348, 1.68233788).is_single);
  EXPECT_FALSE(of(0.1000000015, 3).is_single);
}

TEST(WrittenDigits, TellWhatRoundingCanDo) {
  // As many decimals, or as many digits: what is coarser.
  EXPECT_DOUBLE_EQ(rounding_of(100, of(100.123456, 0.5)), 0.5e-6);
  EXPECT_DOUBLE_EQ(rounding_of(0.5, of(100.123456, 0.5)), 0.5e-6);
  EXPECT_DOUBLE_EQ(rounding_of(12, of(12.3456, 0.00123456)), 0.5e-4);
  EXPECT_LT(rounding_of(1, of(1. / 3, 1)), 1e-15);
  EXPECT_GT(rounding_of(1, of(static_cast<double>(0.1F), 1)), 1e-7);
  EXPECT_EQ(rounding_of(0, digits_of(std::vector<Vec3>{Vec3::Zero()})), 0);
}

TEST(WrittenDigits, PartNoPlanesAcrossAnAxis) {
  const std::vector<Vec3> floor = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const std::vector<Vec3> sheet = {{0, 0, 1e-6}, {1, 0, 1e-6}, {0, 1, 1e-6}};
  const std::vector<Vec3> slanted = {{0, 0, 1e-6}, {1, 0, 0}, {0, 1, 1e-6}};
  EXPECT_EQ(rounding_between(floor, sheet, Vec3::UnitZ()), 0);
  EXPECT_DOUBLE_EQ(rounding_between(floor, slanted, Vec3::UnitZ()), 1e-6);
}

TEST(WrittenDigits, OfOnePlane) {
  const std::vector<Vec3> level = {{0, 0, 1.23456}, {4.56789, 0, 1.23456}, {0, 4, 1.23456}};
  EXPECT_EQ(rounding_of_plane(level, Vec3::UnitZ()), 0) << "equal numbers are rounded equally";
  const std::vector<Vec3> slanted = {{0, 0, 1.23456}, {4.56789, 0, 1.34567}, {0, 4, 1.23456}};
  EXPECT_DOUBLE_EQ(rounding_of_plane(slanted, Vec3::UnitZ()), 1e-5);
  EXPECT_DOUBLE_EQ(rounding_of_plane(slanted, Vec3::UnitY()), 1e-5);
  EXPECT_DOUBLE_EQ(rounding_of_plane(slanted, Vec3(0, 0.6, 0.8)), 1.4e-5);
}

TEST(WrittenDigits, AreFiveAtLeast) {
  const std::vector<Vec3> meant = {{0, 0, 1.2}, {4.5, 0, 1.3}, {0, 4, 1.2}};
  EXPECT_DOUBLE_EQ(rounding_of_plane(meant, Vec3::UnitZ()), 1e-4);
  const std::vector<Vec3> larger = {{0, 0, 12}, {45, 0, 13}, {0, 40, 12}};
  EXPECT_DOUBLE_EQ(rounding_of_plane(larger, Vec3::UnitZ()), 1e-3);
  // Five decimals of small numbers are fewer digits.
  const std::vector<Vec3> small = {{0, 0, 0.01234}, {0.04567, 0, 0.02345}, {0, 0.04, 0.01234}};
  EXPECT_DOUBLE_EQ(rounding_of_plane(small, Vec3::UnitZ()), 1e-6);
}

}  // namespace
}  // namespace halfshade
