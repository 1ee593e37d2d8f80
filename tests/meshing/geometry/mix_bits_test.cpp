#include "meshing/geometry/mix_bits.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(MixBits, GivesTheSequenceOfSplitmix64) {
  EXPECT_EQ(mix_bits(0), 0xe220a8397b1dcdaf);
  EXPECT_EQ(mix_bits(splitmix_step), 0x6e789e6aa1b965f4);
  EXPECT_EQ(mix_bits(2 * splitmix_step), 0x06c45d188009454f);
}

}  // namespace
}  // namespace halfshade
