#include "meshing/core/light_source.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/one_sided_derivatives.h"
#include "tests/support/signature_bisection.h"

#include <gtest/gtest.h>

// None of the curves is missing: along random segments on random surfaces, the structure of what
// is visible changes at curves only.

namespace halfshade {
namespace {

using test::NamedScene;
using test::SegmentAudit;
using test::SignatureChange;

std::vector<int> emitters_of(const std::vector<LightSource>& sources) {
  std::vector<int> emitters;
  for (const LightSource& source : sources) emitters.push_back(source.surface);
  return emitters;
}

std::string jumps_at(const SignatureChange& change, const SoundScene& scene) {
  const DirectLightIndex index(scene);
  const Vec2 across = (change.after - change.before).normalized();
  const auto measured = test::JumpMeter(scene, index)
                            .measure(change.receiver, change.emitter,
                                     0.5 * (change.before + change.after), across, change.miss);
  if (!measured) return "no room to measure a jump";
  return fmt::format("jumps along the segment {:.3g}, {:.3g}, {:.3g} (to ± {:.2g})",
                     measured->jump[0], measured->jump[1], measured->jump[2], measured->reach);
}

/// Segments along a scene with the curves that `options` find; misses are failures if `expect`.
SegmentAudit audit(const NamedScene& named, int segments, bool expect,
                   const DiscontinuityOptions& options = {}) {
  const SoundScene& scene = named.scene;
  const OpaqueScene opaque(scene);
  const std::vector<LightSource> sources = light_sources(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, sources, options);
  test::SegmentAuditor auditor(scene, opaque, found.curves);
  SegmentAudit result = auditor.run(emitters_of(sources), segments, 20);
  for (const auto* misses : {&result.misses, &result.at_horizon}) {
    if (!expect || misses->empty()) continue;
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, misses->size()); ++i)
      text += auditor.describe((*misses)[i]) + "  " + jumps_at((*misses)[i], scene) + "\n";
    ADD_FAILURE() << named.name << ": " << misses->size()
                  << (misses == &result.at_horizon ? " at the horizon are missed" : " are missed")
                  << " among " << result.changes << " changes on " << result.segments
                  << " segments, " << found.curves.size() << " curves\n"
                  << text;
  }
  return result;
}

TEST(DiscontinuityCompleteness, TheVisiblePartChangesOnlyAtCurves) {
  std::size_t segments = 0, changes = 0;
  for (const NamedScene& named : test::discontinuity_scenes()) {
    if (!test::is_wanted(named.name)) continue;
    const SegmentAudit result = audit(named, 370 * test::effort(), true);
    segments += result.segments;
    changes += result.changes;
  }
  RecordProperty("segments", static_cast<int>(segments));
  RecordProperty("changes", static_cast<int>(changes));
  if (std::getenv("HALFSHADE_SCENE")) return;
  EXPECT_GE(segments, 10000u);
  EXPECT_GE(changes, 20000u) << "segments that cross nothing prove nothing";
}

TEST(DiscontinuityCompleteness, AlsoWhereThingsTouchAndEventsCoincide) {
  for (const NamedScene& named : test::degenerate_scenes())
    if (test::is_wanted(named.name)) audit(named, 150 * test::effort(), true);
}

/// So the tests above can fail: without events of three edges, or with a vertex, there are misses.
TEST(DiscontinuityCompleteness, WhatIsLeftOutIsMissed) {
  const auto misses = [](const SoundScene& scene, const DiscontinuityOptions& options) {
    return audit({"", scene}, 60, false, options).misses.size();
  };
  const SoundScene skew = test::skew_bars_maker().sound();
  EXPECT_GT(misses(skew, {.eee = false}), 5u);
  EXPECT_GT(misses(test::one_triangle(), {.ev = false}), 5u);
  EXPECT_EQ(misses(skew, {}), 0u);
}

/// Nor without those along the horizon.
TEST(DiscontinuityCompleteness, WhatComesOverTheHorizonIsAmongThem) {
  const SegmentAudit result =
      audit({"", test::table_and_chairs_maker().sound()}, 370, false, {.horizon = false});
  EXPECT_EQ(result.misses.size(), 0u);
  EXPECT_GT(result.at_horizon.size(), 5u);
}

/// Lines along the horizon are of the third order: nothing else jumps there.
TEST(DiscontinuityCompleteness, EventsAtTheHorizonAreSmoothToTheSecondOrder) {
  int measured = 0;
  for (const SoundScene& scene :
       {test::light_through_the_horizon(), test::table_and_chairs_maker().sound()}) {
    const OpaqueScene opaque(scene);
    const DirectLightIndex index(scene);
    test::SegmentAuditor auditor(scene, opaque, {});
    const SegmentAudit audit = auditor.run(index.emitters(), 150, 3);
    for (const SignatureChange& change : audit.at_horizon) {
      const Vec2 across = (change.after - change.before).normalized();
      // Near the edges of occluders the irradiance varies fast.
      const double clear = std::min(change.miss, 2e-4 * scene.diagonal);
      const auto jump = test::JumpMeter(scene, index)
                            .measure(change.receiver, change.emitter,
                                     0.5 * (change.before + change.after), across, clear);
      if (!jump) continue;
      ++measured;
      EXPECT_NEAR(jump->jump[0], 0, 1e-13) << auditor.describe(change);
      EXPECT_NEAR(jump->jump[1], 0, 1e-10) << auditor.describe(change);
      EXPECT_NEAR(jump->jump[2], 0, 1e-6 * (1 + jump->scale[2])) << auditor.describe(change);
    }
  }
  EXPECT_GT(measured, 30);
}

/// The auditor itself, where it is known what it must find.
TEST(SegmentAudit, FindsTheShadowLinesOfASquare) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  test::SegmentAuditor auditor(scene, opaque, {});
  const std::array<int, 1> light = {0};
  const SegmentAudit audit = auditor.run(light, 200, 11);
  EXPECT_GT(audit.changes, 300u);
  EXPECT_EQ(audit.misses.size(), audit.changes);
  for (const SignatureChange& change : audit.misses) {
    EXPECT_EQ(change.receiver, 2);
    const Vec3 p = scene.surfaces[2].frame.to_space(change.before);
    double nearest = HUGE_VAL;
    for (const double line : {0.25, 1.25})
      nearest =
          std::min({nearest, std::abs(std::abs(p.x()) - line), std::abs(std::abs(p.y()) - line)});
    EXPECT_LT(nearest, 1e-9);
    EXPECT_LT(std::max(std::abs(p.x()), std::abs(p.y())), 1.25 + 1e-9);
  }
}

/// Every exact curve of S1 put in by hand satisfies the auditor, and one left out does not.
TEST(SegmentAudit, IsSatisfiedByTheLinesAndOnlyByAll) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  std::vector<DiscontinuityCurve> curves;
  const PlaneFrame& floor = scene.surfaces[2].frame;
  for (const double line : {-1.25, -0.25, 0.25, 1.25})
    for (const bool along_x : {false, true}) {
      DiscontinuityCurve curve;
      curve.receiver = 2;
      const Vec3 a(line, -1.25, 0), b(line, 1.25, 0);
      curve.arc = straight_arc(floor.to_plane(along_x ? Vec3(a.y(), a.x(), 0) : a),
                               floor.to_plane(along_x ? Vec3(b.y(), b.x(), 0) : b));
      curves.push_back(curve);
    }
  const std::array<int, 1> light = {0};
  EXPECT_TRUE(test::SegmentAuditor(scene, opaque, curves).run(light, 200, 12).misses.empty());
  curves.pop_back();
  EXPECT_FALSE(test::SegmentAuditor(scene, opaque, curves).run(light, 200, 12).misses.empty());
}

}  // namespace
}  // namespace halfshade
