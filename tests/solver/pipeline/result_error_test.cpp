#include "solver/pipeline/result_error.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(ErrorInstead, HasAsManyDigitsAsTellTheTwoApart) {
  EXPECT_EQ(error_instead(0.0123, "the irradiance", 0.01),
            "0.012 of the irradiance instead of 0.01");
  EXPECT_EQ(error_instead(0.01004, "all", 0.01), "0.01004 of all instead of 0.01");
  EXPECT_EQ(error_instead(0.01 + 1e-12, "all", 0.01), "0.01 of all instead of 0.01");
}

}  // namespace
}  // namespace halfshade
