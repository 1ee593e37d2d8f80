#include "meshing/backprojection/edge_id.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace halfshade {
namespace {

TEST(EdgeId, IsSortedByKindAndTheEmittersEdgesBackwards) {
  const std::vector<EdgeId> sorted = {
      EdgeId::horizon(), EdgeId::emitter_edge(1), EdgeId::emitter_edge(0), EdgeId::edge(0),
      EdgeId::edge(7),   EdgeId::cut(0),          EdgeId::cut(3)};
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j) {
      EXPECT_EQ(sorted[i] < sorted[j], i < j);
      EXPECT_EQ(sorted[i] == sorted[j], i == j);
    }
}

TEST(EdgeId, TellsTheEmittersOutlineFromTheScene) {
  EXPECT_TRUE(EdgeId::horizon().is_of_outline());
  EXPECT_TRUE(EdgeId::emitter_edge(2).is_of_outline());
  EXPECT_FALSE(EdgeId::edge(2).is_of_outline());
  EXPECT_FALSE(EdgeId::cut(2).is_of_outline());
}

}  // namespace
}  // namespace halfshade
