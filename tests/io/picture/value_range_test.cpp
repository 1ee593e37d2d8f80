#include "io/picture/value_range.h"

#include "io/picture/linear_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace halfshade {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

void expect_range(const ValueRange& range, double low, double high) {
  EXPECT_DOUBLE_EQ(range.low, low);
  EXPECT_DOUBLE_EQ(range.high, high);
}

TEST(ValueRange, LeavesOutAPercentAtEitherEnd) {
  std::vector<double> values(1001);
  std::iota(values.begin(), values.end(), 1000.);
  values.front() = -1e9;
  values.back() = 1e9;
  expect_range(robust_range(values, ValueScale::linear), 1010, 1990);
  expect_range(robust_range(values, ValueScale::linear, true), -1e9, 1e9);
}

TEST(ValueRange, BeginsAtZeroWhereTheLowestIsSmall) {
  expect_range(robust_range({0.1, 0.5, 1}, ValueScale::linear), 0, 1);
  expect_range(robust_range({-0.1, 0.5, 1}, ValueScale::linear), -0.1, 1);
  expect_range(robust_range({0.5, 1}, ValueScale::linear), 0.5, 1);
}

TEST(ValueRange, IsNeverEmpty) {
  expect_range(robust_range({}, ValueScale::linear), 0, 1);
  expect_range(robust_range({no_number, endless}, ValueScale::linear), 0, 1);
  expect_range(robust_range({0, 0}, ValueScale::linear), 0, 1);
  expect_range(robust_range({3, 3, no_number}, ValueScale::linear), 0, 3);
  expect_range(robust_range({-3, -3}, ValueScale::linear), -3, 0);
  expect_range(robust_range({2, 2}, ValueScale::linear, true), 1.5, 2.5);
  expect_range(robust_range({0, -1}, ValueScale::log), 0.1, 1);
  expect_range(robust_range({0, 5, 5}, ValueScale::log), 0.5, 5);
  expect_range(robust_difference_range({}), -1, 1);
  expect_range(robust_difference_range({0, 0}), -1, 1);
}

TEST(ValueRange, LogarithmsTakeNoMoreThanSixDecades) {
  expect_range(robust_range({-1, 0, 1e-30, 1}, ValueScale::log), 1e-6, 1);
  expect_range(robust_range({1e-3, 1}, ValueScale::log), 1e-3, 1);
}

TEST(ValueRange, DifferencesHaveZeroInTheMiddle) {
  expect_range(robust_difference_range({-3, 1, 2}), -3, 3);
  std::vector<double> most_zero(1000, 0.);
  most_zero.push_back(-2);
  expect_range(robust_difference_range(most_zero), -2, 2);
}

TEST(ValueRange, SharesAreEvenInValuesOrLogarithms) {
  EXPECT_DOUBLE_EQ(share_in({2, 6}, ValueScale::linear, 3), 0.25);
  EXPECT_DOUBLE_EQ(share_in({2, 6}, ValueScale::linear, 0), -0.5);
  EXPECT_NEAR(share_in({1e-2, 1e2}, ValueScale::log, 0.1), 0.25, 1e-15);
  EXPECT_EQ(share_in({1, 10}, ValueScale::log, 0), -endless);
  EXPECT_TRUE(std::isnan(share_in({1, 10}, ValueScale::log, no_number)));
  EXPECT_TRUE(std::isnan(share_in({1, 10}, ValueScale::linear, no_number)));
}

std::string labels(double low, double high, int most, bool is_whole = false) {
  std::string text;
  for (const detail::Tick& tick : detail::linear_ticks(low, high, most, is_whole))
    text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

TEST(LinearTicks, AreRoundAndNoMoreThanAskedFor) {
  EXPECT_EQ(labels(0, 1, 6), "0 0.2 0.4 0.6 0.8 1");
  EXPECT_EQ(labels(0, 1, 5), "0 0.5 1");
  EXPECT_EQ(labels(-0.065, 0.065, 8), "-0.06 -0.04 -0.02 0 0.02 0.04 0.06");
  EXPECT_EQ(labels(3e-7, 9e-7, 4), "4e-07 6e-07 8e-07");
  EXPECT_EQ(labels(1000.001, 1000.004, 4), "1000.001 1000.002 1000.003 1000.004");
  EXPECT_EQ(labels(0, 3, 20, true), "0 1 2 3");
  EXPECT_EQ(labels(0, 200, 5, true), "0 50 100 150 200");
}

}  // namespace
}  // namespace halfshade
