#include "meshing/discontinuity/sight_casting.h"

#include "tests/support/lit_scene.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace halfshade {
namespace {

using test::LitScene;
using test::SceneMaker;

/// Straight down from the light at (x, y), past a feature at height z.
SightLine downwards(double x, double y, double z) { return {{x, y, 2}, {x, y, z}, -Vec3::UnitZ()}; }

/// Heights of the surfaces that a line ends on.
std::vector<double> heights(const LitScene& lit, const SightLine& line) {
  SightCaster caster(lit.scene, lit.opaque);
  std::vector<double> found;
  for (const int s : caster.cast(line)) {
    const PlaneFrame& frame = lit.scene.surfaces[at(s)].frame;
    EXPECT_LT(frame.normal.dot(line.direction), 0) << "it faces the light";
    found.push_back(frame.origin.z());
  }
  return found;
}

TEST(SightCaster, EndsOnTheFirstSurfaceAfterTheFeature) {
  const LitScene lit(SceneMaker().square_light().floor().up({-0.3, -0.3}, {0.3, 0.3}, 1));
  EXPECT_EQ(heights(lit, downwards(0.1, 0.05, 1.5)), std::vector<double>{1});
  EXPECT_EQ(heights(lit, downwards(0.4, 0.05, 1.5)), std::vector<double>{0});
  EXPECT_EQ(heights(lit, downwards(5, 0.05, 1.5)), std::vector<double>{});
}

TEST(SightCaster, IsBlockedByWhatLiesBeforeTheFeature) {
  const LitScene lit(SceneMaker().square_light().floor().up({-0.3, -0.3}, {0.3, 0.3}, 1));
  EXPECT_EQ(heights(lit, downwards(0.1, 0.05, 0.5)), std::vector<double>{});
  EXPECT_EQ(heights(lit, downwards(0.3, 0.05, 0.5)), std::vector<double>{0}) << "it only grazes";
}

TEST(SightCaster, FindsWhatItGrazesAndWhatLiesBehind) {
  const LitScene lit(SceneMaker().square_light().floor().up({-0.3, -0.3}, {0.3, 0.3}, 1));
  EXPECT_EQ(heights(lit, downwards(0.3, 0.05, 1.5)), (std::vector<double>{1, 0}));
  EXPECT_EQ(heights(lit, downwards(0.3, 0.05, 1)), std::vector<double>{0}) << "the feature itself";
}

TEST(SightCaster, EndsOnTheSideThatFacesTheLight) {
  const LitScene back(SceneMaker().square_light().floor().down({-0.3, -0.3}, {0.3, 0.3}, 1));
  EXPECT_EQ(heights(back, downwards(0.1, 0.05, 1.5)), std::vector<double>{});
  const LitScene both(SceneMaker().square_light().floor().polygon(
      {{-0.3, 0.3, 1}, {0.3, 0.3, 1}, {0.3, -0.3, 1}, {-0.3, -0.3, 1}}, test::two_sided_grey));
  EXPECT_EQ(heights(both, downwards(0.1, 0.05, 1.5)), std::vector<double>{1});
}

// Rounding says which of two faces back to back a line meets first.
TEST(SightCaster, EndsOnTheFaceThatLooksTowardsTheLightOfTwoBackToBack) {
  test::Random random(4);
  for (int i = 0; i < 40; ++i) {
    const PlaneFrame plane = make_frame({0, 0, 1}, random.direction() + 1.5 * Vec3::UnitZ());
    std::vector<Vec3> corners;
    for (const Vec2& p : {Vec2(-0.7, -0.6), Vec2(0.6, -0.7), Vec2(0.8, 0.6), Vec2(-0.6, 0.7)})
      corners.push_back(plane.to_space(p));
    const std::vector<Vec3> under = {corners[2], corners[1], corners[0], corners[3]};
    const LitScene lit(SceneMaker().square_light().floor().polygon(corners).polygon(under));
    for (int k = 0; k < 20; ++k)
      EXPECT_EQ(heights(lit, downwards(random(-0.3, 0.3), random(-0.3, 0.3), 1.8)).size(), 1u)
          << "pair " << i;
  }
}

}  // namespace
}  // namespace halfshade
