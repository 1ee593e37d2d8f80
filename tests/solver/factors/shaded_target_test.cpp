#include "solver/factors/shaded_target.h"

#include "solver/direct/direct_light.h"
#include "solver/factors/few_blockers.h"
#include "tests/support/random.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A wall hangs down from the ceiling, whose corners rounding has put on the ceiling's level, or
/// hardly above or below: its shadows on the floor, which those of sheets cut into parts, have no
/// end.
TEST(ShadedTarget, OfWallsThatReachUpToThePoint) {
  for (const double top : {std::nextafter(1, 0), 1., std::nextafter(1, 2)}) {
    test::SceneMaker maker;
    maker.down({0, 0}, {1, 1}, 1).up({-.3, -.4}, {1.2, 1.1}, 0);
    for (const double x : {-.1, .4, .9})
      for (const double y : {-.2, .3, .8}) maker.up({x, y}, {x + .1, y + .1}, .1);
    maker.polygon({{.2, .1, top}, {.2, .1, .3}, {.8, .7, .3}, {.8, .7, top}});
    const SoundScene sound = maker.sound();
    const SightScene sight = make_sight_scene(sound);
    FewBlockers blockers(sight, 0, 1);
    ASSERT_TRUE(blockers.is_applicable());
    ASSERT_EQ(blockers.things(), 10u);
    SharedShadows shadows(sight);
    TargetMemory memory;
    const ShadedTarget target = blockers.shaded_target(shadows, memory);
    test::Random random(5);
    double hidden = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3 point(random(0, 1), random(0, 1), 1);
      shadows.move_to(point);
      HiddenFactor found, expected;
      ASSERT_TRUE(target.hidden_factor(found));
      ASSERT_TRUE(blockers.factor(point, expected));
      EXPECT_NEAR(found.hidden, expected.hidden, 1e-13);
      hidden += expected.hidden;
    }
    EXPECT_GT(hidden, 1);
  }
}

/// A slanted sheet hardly below the point, as seen from a plane a thousand times as far off: some
/// of its corners are thrown farther than others, in the same direction, and no farther aside.
TEST(ShadedTarget, OfSheetsThatAreThrownFar) {
  for (const double far : {300., 500., 2000., 1e5}) {
    test::SceneMaker maker;
    maker.up({0, 0}, {1, 1}, 0).down({-far, -far}, {far, far}, far);
    maker.polygon({{.1, .1, .6}, {.8, .2, .7}, {.3, .9, .5}});
    maker.up({.31, .17}, {.62, .48}, .3);
    const SoundScene sound = maker.sound();
    const SightScene sight = make_sight_scene(sound);
    const DirectLightIndex exact(sound);
    FewBlockers blockers(sight, 0, 1);
    ASSERT_EQ(blockers.things(), 2u);
    SharedShadows shadows(sight);
    TargetMemory memory;
    const ShadedTarget target = blockers.shaded_target(shadows, memory);
    test::Random random(3);
    for (int k = 0; k < 1000; ++k) {
      const Vec3 point(random(0, 1), random(0, 1), 0);
      shadows.move_to(point);
      HiddenFactor found;
      ASSERT_TRUE(target.hidden_factor(found));
      const PointFactor expected = exact.factor({point, Vec3::UnitZ()}, 1);
      ASSERT_NEAR(found.hidden, expected.unobstructed - expected.visible, 1e-12 + 1e-15 * far)
          << far;
    }
  }
}

}  // namespace
}  // namespace halfshade
