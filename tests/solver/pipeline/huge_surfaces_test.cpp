// Surfaces far larger than the rest say nothing about how fine the rest should be; what happens on
// a small part of them is found.

#include "solver/pipeline/solve.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <vector>

namespace halfshade {
namespace {

std::vector<Vec3> square(double half, double z, bool up) {
  if (up) return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  return {{-half, half, z}, {half, half, z}, {half, -half, z}, {-half, -half, z}};
}

/// A floor, a table .1 above it, a lamp of 2 × 2 that looks down from 2.
Scene lamp_and_table(double half_floor, double rho) {
  Scene scene;
  const int grey = test::add_material(scene, rho, 0), light = test::add_material(scene, rho, 1);
  scene.groups = {"floor", "top", "under", "lamp"};
  test::add_polygon(scene, square(half_floor, 0, true), grey);
  test::add_polygon(scene, square(.5, .1, true), grey);
  test::add_polygon(scene, square(.5, .1, false), grey);
  test::add_polygon(scene, square(1, 2, false), light);
  for (int f = 0; f < 4; ++f) scene.faces[at(f)].group = f;
  return scene;
}

/// W on each group.
std::vector<double> powers(const SolveResult& result) {
  std::vector<double> power(result.scene.groups.size(), 0.);
  for (int e = 0; e < result.elements.count(); ++e)
    power[at(result.elements.group[at(e)])] +=
        result.elements.area[at(e)] * result.solution.irradiance(e, 0);
  return power;
}

TEST(HugeSurfaces, ALampInAnEmptyPlainLightsIt) {
  for (const double half : {20., 200., 2e4, 2e6}) {
    const SolveResult result = solve(lamp_and_table(half, 0), {});
    EXPECT_EQ(result.not_reached, "");
    const std::vector<double> power = powers(result);
    // All that the lamp sends out arrives, but for what passes the floor's borders.
    EXPECT_NEAR(power[0] + power[1], 4, .02 + 4 * 4 / (half * half)) << half;
  }
}

TEST(HugeSurfaces, WhatTheyReflectIsThatOfALargeFloor) {
  const std::vector<double> expected = powers(solve(lamp_and_table(20, .5), {}));
  const std::vector<double> power = powers(solve(lamp_and_table(2e4, .5), {}));
  for (const std::size_t group : {0u, 1u, 3u})
    EXPECT_NEAR(power[group], expected[group], .02 * expected[group]) << group;
}

TEST(HugeSurfaces, AFarBlackTriangleChangesNothing) {
  const Scene alone = lamp_and_table(2, .5);
  const std::vector<double> expected = powers(solve(alone, {}));
  for (const double far : {3e2, 1e3, 1e6, 1e8}) {
    Scene scene = alone;
    scene.groups.push_back("far");
    test::add_polygon(scene, {{far, 0, 0}, {far, far, 0}, {far, far, far}},
                      test::add_material(scene, 0, 0));
    scene.faces.back().group = 4;
    const SolveResult result = solve(scene, {});
    EXPECT_EQ(result.not_reached, "") << far;
    const std::vector<double> power = powers(result);
    for (const std::size_t group : {0u, 1u, 3u})
      EXPECT_NEAR(power[group], expected[group], .01 * expected[group]) << far << " " << group;
  }
}

TEST(HugeSurfaces, ASunLightsTheSameFromAnyDistance) {
  std::vector<double> expected;
  for (const double far : {1e3, 1e5, 1e9}) {
    Scene scene = lamp_and_table(2, .5);
    for (const int v : scene.faces[3].vertices) {
      Vec3& p = scene.vertices[at(v)];
      p = Vec3(4.65e-3 * far * p.x(), 4.65e-3 * far * p.y(), far);
    }
    const SolveResult result = solve(scene, {});
    EXPECT_EQ(result.not_reached, "") << far;
    const std::vector<double> power = powers(result);
    if (expected.empty()) expected = power;
    for (const std::size_t group : {0u, 1u, 2u})
      EXPECT_NEAR(power[group], expected[group], .01 * expected[group]) << far << " " << group;
  }
}

}  // namespace
}  // namespace halfshade
