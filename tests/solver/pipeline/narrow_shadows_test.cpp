// Shadows and penumbrae that lie between the points at which light is looked at.

#include "tests/support/direct_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

std::vector<Vec3> rectangle(double x0, double y0, double x1, double y1, double z, bool up) {
  if (up) return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return {{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}};
}

/// A floor of 4 × 4, and a lamp so wide that looks down from a height.
Scene floor_and_lamp(double height, double width) {
  Scene scene;
  test::add_polygon(scene, rectangle(-2, -2, 2, 2, 0, true), test::add_material(scene, .5, 0));
  test::add_polygon(scene, rectangle(-width / 2, -width / 2, width / 2, width / 2, height, false),
                    test::add_material(scene, 0, 1e3));
  return scene;
}

SolveResult direct_light(const Scene& scene, double tolerance) {
  return solve(scene, test::directly(tolerance));
}

TEST(NarrowShadows, APlateThrowsOneHoweverLargeAndFarTheSunIs) {
  for (const double height : {20., 400., 500., 1e3, 1e5})
    for (const double tolerance : {1e-2, 1e-3}) {
      Scene scene = floor_and_lamp(height, .05 * height);
      test::add_polygon(scene, rectangle(-.5, -.3, .1, .4, .5, false), 0);
      const SolveResult result = direct_light(scene, tolerance);
      EXPECT_EQ(result.not_reached, "");
      const double error = test::direct_error(PreparedScene(scene), result, 300);
      EXPECT_LT(error, 1.02 * tolerance) << height;
      EXPECT_GT(error, .2 * tolerance) << height;
    }
}

/// Sides and top of a box that stands on the floor.
void add_box(Scene& scene, const Vec3& low, const Vec3& high) {
  const Vec2 corners[] = {
      {low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}};
  for (int k = 0; k < 4; ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % 4];
    test::add_polygon(scene,
                      {{a.x(), a.y(), low.z()},
                       {b.x(), b.y(), low.z()},
                       {b.x(), b.y(), high.z()},
                       {a.x(), a.y(), high.z()}},
                      0);
  }
  test::add_polygon(scene, rectangle(low.x(), low.y(), high.x(), high.y(), high.z(), true), 0);
}

TEST(NarrowShadows, PenumbraeAtTheFeetOfBoxesKeepTheTolerance) {
  test::Random random(7);
  for (int k = 0; k < 30; ++k) {
    const double height = std::pow(10., random(1.3, 2.5));
    Scene scene = floor_and_lamp(height, height * std::pow(10., random(-2.3, -1.3)));
    const Vec3 low(random(-1.5, .8), random(-1.5, .8), 0);
    add_box(scene, low, low + Vec3(random(.2, .8), random(.2, .8), random(.1, .8)));
    const double tolerance = k % 2 == 0 ? 1e-2 : 5e-3;
    const SolveResult result = direct_light(scene, tolerance);
    EXPECT_EQ(result.not_reached, "");
    const double error = test::direct_error(PreparedScene(scene), result, 700);
    EXPECT_LT(error, 1.03 * tolerance) << k;
    EXPECT_GT(result.relative_error, .85 * error) << k;
  }
}

}  // namespace
}  // namespace halfshade
