#include "meshing/events/critical_event.h"

#include "meshing/core/error.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(FeatureOf, NamesEdgesOfTheSceneAndOfTheEmitter) {
  EXPECT_EQ(feature_of(EdgeId::edge(5)), (Feature{Feature::Kind::edge, 5}));
  EXPECT_EQ(feature_of(EdgeId::emitter_edge(2)), (Feature{Feature::Kind::emitter_edge, 2}));
}

TEST(FeatureOf, RefusesCutsAndTheHorizon) {
  EXPECT_THROW(feature_of(EdgeId::cut(1)), Error);
  EXPECT_THROW(feature_of(EdgeId::horizon()), Error);
}

}  // namespace
}  // namespace halfshade
