// Shadows and penumbrae that lie between the points at which light is looked at.

#include "tests/support/direct_error.h"
#include "tests/support/scenes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

std::vector<Vec3> rectangle(double x0, double y0, double x1, double y1, double z, bool up) {
  if (up) return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return {{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}};
}

/// A floor of 4 × 4, or twice `half`, and a lamp so wide that looks down from a height.
Scene floor_and_lamp(double height, double width, double half = 2) {
  Scene scene;
  test::add_polygon(scene, rectangle(-half, -half, half, half, 0, true),
                    test::add_material(scene, .5, 0));
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

/// Both sides of a polygon.
void add_sheet(Scene& scene, std::vector<Vec3> corners) {
  test::add_polygon(scene, corners, 0);
  std::reverse(corners.begin(), corners.end());
  test::add_polygon(scene, corners, 0);
}

/// Turned about the z axis by an angle.
std::vector<Vec3> turned(std::vector<Vec3> corners, double angle) {
  for (Vec3& p : corners) p = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * p;
  return corners;
}

void expect_tolerance_is_kept(const Scene& scene, const char* name) {
  for (const double tolerance : {1e-2, 1e-3}) {
    const SolveResult result = direct_light(scene, tolerance);
    EXPECT_EQ(result.not_reached, "") << name;
    const int points = std::max(40000 / result.elements.count(), 50);
    const double error = test::direct_error(PreparedScene(scene), result, points);
    // What random points tell of it is known to some per cent.
    EXPECT_LT(error, 1.05 * tolerance) << name;
    EXPECT_GT(result.relative_error, .85 * error) << name;
  }
}

TEST(NarrowShadows, AllLightMayComeThroughASlit) {
  for (const double half_width : {.001, .003}) {
    Scene scene = floor_and_lamp(1.24, .026, 3.4);
    // Beside the middle of the lamp.
    const double z = .92, x = -.053;
    test::add_polygon(scene, turned(rectangle(-20, -20, x - half_width, 20, z, false), .27), 0);
    test::add_polygon(scene, turned(rectangle(x + half_width, -20, 20, 20, z, false), .27), 0);
    expect_tolerance_is_kept(scene, "slit");
  }
}

TEST(NarrowShadows, ThePinholeOfAWideScreenIsFoundBesideOtherLight) {
  Scene scene = floor_and_lamp(1.5, .2, 3);
  const double half = .00125, x = .14, y = .09;
  test::add_polygon(scene, rectangle(-20, -20, x - half, 20, 1, false), 0);
  test::add_polygon(scene, rectangle(x + half, -20, 20, 20, 1, false), 0);
  test::add_polygon(scene, rectangle(x - half, -20, x + half, y - half, 1, false), 0);
  test::add_polygon(scene, rectangle(x - half, y + half, x + half, 20, 1, false), 0);
  // As much light as comes through the hole.
  test::add_polygon(scene, rectangle(-1, -1, 1, 1, 10, true), 0);
  test::add_polygon(scene, rectangle(-.5, -.5, .5, .5, 11, false),
                    test::add_material(scene, 0, 1e-3));
  expect_tolerance_is_kept(scene, "pinhole");
}

TEST(NarrowShadows, BarsThatReachFarBeyondTheFloorThrowThem) {
  for (const double width : {.0006, .002}) {
    Scene scene = floor_and_lamp(2, .002);
    add_sheet(scene, turned(rectangle(-.9, .11, 60, .11 + width, .4, true), .2));
    expect_tolerance_is_kept(scene, "bar");
  }
}

TEST(NarrowShadows, TheArmsOfAConcaveOutlineThrowThem) {
  Scene scene = floor_and_lamp(2, .002);
  std::vector<Vec3> comb = {{-3, -3, .3}, {3, -3, .3}, {3, -2.9, .3}};
  constexpr double half_width = .0005;
  for (const double x : {.53, .17, -.21, -.48})
    for (const auto& [side, y] : {std::pair(1, -2.9), {1, .7}, {-1, .7}, {-1, -2.9}})
      comb.push_back({x + side * half_width, y, .3});
  comb.push_back({-3, -2.9, .3});
  add_sheet(scene, comb);
  expect_tolerance_is_kept(scene, "comb");
}

}  // namespace
}  // namespace halfshade
