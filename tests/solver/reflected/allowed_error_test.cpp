#include "solver/reflected/allowed_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// Of light of norm 1 to 1 %, where `other` is off as well.
double allowed(double other) {
  ReflectedOptions options;
  options.tolerance = 0.01;
  options.other_error = other;
  return std::sqrt(allowed_square(options, Rgb::Ones(), 1));
}

TEST(AllowedError, IsWhatOthersLeave) {
  EXPECT_DOUBLE_EQ(allowed(0), 0.01);
  EXPECT_DOUBLE_EQ(allowed(0.006), 0.008);
}

TEST(AllowedError, IsAFifthWhereNothingIsLeft) {
  EXPECT_DOUBLE_EQ(allowed(0.00999), 0.002);
  EXPECT_DOUBLE_EQ(allowed(0.01), 0.002);
  EXPECT_DOUBLE_EQ(allowed(0.1), 0.02) << "of what is off anyway";
}

}  // namespace
}  // namespace halfshade
