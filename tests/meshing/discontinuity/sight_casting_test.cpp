#include "meshing/discontinuity/sight_casting.h"

#include "tests/support/lit_scene.h"

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

}  // namespace
}  // namespace halfshade
