#include "solver/reference/sample_sequence.h"

#include <gtest/gtest.h>

#include <set>

namespace halfshade {
namespace {

TEST(SampleNumbers, ArePutOneIntoEachElementaryRectangle) {
  constexpr int log_count = 6, count = 1 << log_count;
  for (const std::uint64_t seed : {0, 1, 99})
    for (const std::uint32_t use : {0u, 5u})
      for (int wide = 0; wide <= log_count; ++wide) {
        std::set<int> rectangles;
        for (std::uint32_t s = 0; s < count; ++s) {
          const Vec2 p = SampleNumbers(seed, s).pair(use);
          ASSERT_TRUE((p.array() >= 0).all() && (p.array() < 1).all());
          const int columns = 1 << wide, rows = count / columns;
          rectangles.insert(static_cast<int>(p.x() * columns) * rows +
                            static_cast<int>(p.y() * rows));
        }
        EXPECT_EQ(rectangles.size(), at(count)) << seed << " " << use << " " << wide;
      }
}

TEST(SampleNumbers, OfDifferentSeedsAndUsesAreIndependent) {
  // Means of products of centred numbers, 0 within four standard errors; each has variance 1/12.
  constexpr int count = 4096;
  double seeds = 0, uses = 0, coordinates = 0;
  for (int i = 0; i < count; ++i) {
    const SampleNumbers one(at(i), 3), next(at(i) + 1, 3);
    const Vec2 p = one.pair(0);
    seeds += (p.x() - 0.5) * (next.number(0) - 0.5);
    uses += (p.x() - 0.5) * (one.number(1) - 0.5);
    coordinates += (p.x() - 0.5) * (p.y() - 0.5);
  }
  for (const double sum : {seeds, uses, coordinates})
    EXPECT_LT(std::abs(sum) / count, 4 / (12 * std::sqrt(count)));
}

}  // namespace
}  // namespace halfshade
