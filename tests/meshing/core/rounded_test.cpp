#include "meshing/core/rounded.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace halfshade {
namespace {

TEST(Rounded, KeepsThirtyDigits) {
  for (const double x : {0., 1., -2.5, 1 / 3., 1e300, 3e-300, 0.1 + 0.2}) {
    EXPECT_NEAR(rounded(x), x, 0x1p-30 * std::abs(x));
    EXPECT_EQ(rounded(rounded(x)), rounded(x));
    EXPECT_EQ(rounded(-x), -rounded(x));
    EXPECT_EQ(rounded(8 * x), 8 * rounded(x));
  }
  EXPECT_EQ(rounded(2 - 0x1p-40), 2);
  EXPECT_LT(rounded(1.), rounded(1 + 0x1p-28));
}

TEST(Rounded, RoundingDoesNotMatter) {
  EXPECT_EQ(rounded(0.1 + 0.2), rounded(0.3));
  for (int k = 1; k < 1000; ++k)
    for (const double factor : {3., 0.1, 1e9})
      EXPECT_EQ(rounded(k * factor / 7 * 7 / factor), rounded(k)) << k;
}

TEST(Rounded, KeepsWhatIsNotFinite) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rounded(infinity), infinity);
  EXPECT_EQ(rounded(-infinity), -infinity);
}

}  // namespace
}  // namespace halfshade
