#include "meshing/discontinuity/event_decision.h"

#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

// The table [−.375,.375]² at z = 1 under the light [−.5,.5]² at z = 2: on the floor its full shadow
// ends at x = .25, where the light's side x = .5 lines up with its side x = .375.

namespace halfshade {
namespace {

using test::LitScene;
using test::SceneMaker;

struct DecisionTable : LitScene {
  DecisionTable()
      : LitScene(SceneMaker().square_light().up({-0.375, -0.375}, {0.375, 0.375}, 1).floor()) {}

  /// Ids of what lies in x = .375 at the table, and of the light's edges.
  std::vector<EdgeId> group() const {
    std::vector<EdgeId> ids;
    for (const SilhouetteEdge& edge : emitter_scene.edges)
      if (edge.whole.from.x() == 0.375 && edge.whole.to.x() == 0.375)
        ids.push_back(EdgeId::edge(edge.id));
    for (const OutlinePiece& piece : emitter_scene.outline) ids.push_back(piece.id);
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  bool differs(double x, const std::vector<EdgeId>& ids) const {
    EventDecider decider(opaque, emitter_scene);
    return decider.decide({{x, 0.1, 0}, Vec3::UnitZ(), Vec3::UnitX()}, 1e-9, ids).differs;
  }
};

TEST(EventDecider, SeesADifferenceOnTheCurveAndNoneBesideIt) {
  const DecisionTable table;
  const std::vector<EdgeId> ids = table.group();
  ASSERT_EQ(ids.size(), 5u);
  EXPECT_TRUE(table.differs(0.25, ids));
  EXPECT_FALSE(table.differs(0.24, ids));
  EXPECT_FALSE(table.differs(0.26, ids));
}

TEST(EventDecider, AsksOnlyForTheEdgesOfTheGroup) {
  const DecisionTable table;
  EXPECT_FALSE(table.differs(0.25, {}));
}

}  // namespace
}  // namespace halfshade
