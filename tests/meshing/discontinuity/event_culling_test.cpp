#include "meshing/discontinuity/event_culling.h"

#include "meshing/events/events.h"
#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <vector>

namespace halfshade {
namespace {

using test::LitScene;
using test::SceneMaker;

/// A swath of a table under the light, one of its lines, and where that ends on the floor.
struct Event {
  Swath swath;
  SightLine line;
  ReceivingPoint place;
};

struct Table : LitScene {
  Table() : LitScene(SceneMaker().square_light().up({-0.4, -0.4}, {0.4, 0.4}, 1).floor()) {
    while (scene.surfaces[at(floor)].frame.origin.z() != 0) ++floor;
    for (int e = 0; e < static_cast<int>(emitter_scene.edges.size()); ++e)
      edge_swaths(emitter_scene, e, [&](const Swath& swath) {
        const auto line = line_at(swath, emitter_scene.frame, 0.5);
        const auto trace = trace_at(swath, scene.surfaces[at(floor)].frame, 0.5);
        if (!line || !trace) return;
        const Vec3 left = Vec3::UnitZ().cross(trace->tangent).normalized();
        events.push_back({swath, *line, {trace->point, Vec3::UnitZ(), left}});
      });
  }

  std::size_t kept(double least_change) const {
    const EventCulling culling(scene, opaque, emitter_scene, {least_change, 0.1});
    std::size_t count = 0;
    for (const Event& event : events)
      count += culling.may_matter(event.swath, event.line, floor, event.place) ? 1 : 0;
    return count;
  }

  int floor = 0;
  std::vector<Event> events;
};

TEST(EventCulling, KeepsEverythingWithoutALimitAndNothingAboveAllFactors) {
  const Table table;
  ASSERT_GT(table.events.size(), 10u);
  EXPECT_EQ(table.kept(0), table.events.size());
  EXPECT_EQ(table.kept(1e-12), table.events.size());
  EXPECT_EQ(table.kept(10), 0u);
}

TEST(EventCulling, KeepsLessTheHigherTheLimit) {
  const Table table;
  std::size_t before = table.events.size();
  for (const double limit : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    const std::size_t kept = table.kept(limit);
    EXPECT_LE(kept, before) << limit;
    before = kept;
  }
}

TEST(MayBeEvent, OnlyIfTheLineStartsOnTheEmitter) {
  const LitScene lit(SceneMaker().square_light().floor());
  Swath swath;
  const auto may_be = [&](double x) {
    return may_be_event(lit.emitter_scene, swath, {{x, 0, 2}, {x, 0, 1}, -Vec3::UnitZ()});
  };
  EXPECT_TRUE(may_be(0.2));
  EXPECT_FALSE(may_be(0.7));
  swath.ends_on_outline = true;
  EXPECT_TRUE(may_be(0.7)) << "it has been chosen so";
}

TEST(MayBeEvent, OnlyIfItsEdgesMayBeSilhouettes) {
  // The right top edge of a box parts what the light's left sees from what it does not; its right
  // sees both faces.
  const LitScene lit(SceneMaker().square_light().box({-0.2, -0.2, 0.5}, {0.2, 0.2, 1}));
  Swath swath;
  for (std::size_t e = 0; e < lit.emitter_scene.edges.size(); ++e) {
    const Span3& span = lit.emitter_scene.edges[e].whole;
    const bool is_right_top =
        span.from.x() == 0.2 && span.to.x() == 0.2 && span.from.z() == 1 && span.to.z() == 1;
    if (is_right_top) swath.silhouettes[0] = static_cast<int>(e);
  }
  ASSERT_GE(swath.silhouettes[0], 0);
  const Vec3 middle(0.2, 0, 1);
  const auto may_be = [&](double x) {
    const Vec3 start(x, 0, 2);
    return may_be_event(lit.emitter_scene, swath, {start, middle, (middle - start).normalized()});
  };
  EXPECT_TRUE(may_be(-0.4));
  EXPECT_FALSE(may_be(0.4));
}

}  // namespace
}  // namespace halfshade
