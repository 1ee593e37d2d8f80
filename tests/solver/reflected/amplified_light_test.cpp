#include "meshing/repair/repair.h"
#include "solver/reflected/reflected_cost.h"
#include "solver/reflected/reflected_light.h"
#include "tests/support/element_points.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

// Light between two bright plates close to each other is reflected so often that noise of a few
// thousandths in each row moves all of it by a tenth. What rays find is compared with exact parts,
// which random walks confirm in narrow_gap_test.

namespace halfshade {
namespace {

SoundScene plates(double gap, double rho) {
  Scene scene;
  const int white = test::add_material(scene, rho, 1);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, white);
  test::add_polygon(scene, {{0, 1, gap}, {1, 1, gap}, {1, 0, gap}, {0, 0, gap}}, white);
  return make_sound(scene);
}

ReflectedLight solved(const SoundScene& scene, double tolerance, ReflectedVisibility visibility) {
  ReflectedOptions options;
  options.tolerance = tolerance;
  options.visibility = visibility;
  options.through_operator = true;
  return reflected_light(scene, {}, options);
}

/// In the L2 norm, relative.
double difference(const ReflectedLight& light, const ReflectedLight& right) {
  test::Random random(5);
  double square = 0, all = 0;
  for (const auto& [surface, point] : test::spread_points(right.elements(), 2000, random)) {
    const double there = right.irradiance(surface, point.position)[0];
    square += std::pow(light.irradiance(surface, point.position)[0] - there, 2);
    all += there * there;
  }
  return std::sqrt(square / all);
}

TEST(AmplifiedLight, ByRaysIsOffByNoMoreThanIsClaimed) {
  struct Case {
    double gap, rho, tolerance;
  };
  for (const auto& [gap, rho, tolerance] :
       {Case{0.01, 0.999, 0.1}, {0.01, 0.99, 0.05}, {0.005, 0.9, 0.1}}) {
    const SoundScene scene = plates(gap, rho);
    const ReflectedLight right = solved(scene, 0.02, ReflectedVisibility::exact);
    const ReflectedLight found = solved(scene, tolerance, ReflectedVisibility::sampled);
    EXPECT_LT(right.report().error, 0.03);
    EXPECT_LE(difference(found, right), found.report().error + 0.5 * right.report().error)
        << gap << ", " << rho;
    EXPECT_EQ(found.report().end == ReflectedEnd::accurate, found.report().error <= tolerance);
  }
}

TEST(AmplifiedLight, IsFoundByExactPartsUnlessRaysAreAskedFor) {
  const SoundScene scene = plates(0.01, 0.99);
  ReflectedOptions options;
  options.tolerance = 0.1;
  ASSERT_FALSE(reflected_cost(2, options).is_exact) << "before it is known how much it is";
  EXPECT_TRUE(solved(scene, 0.1, ReflectedVisibility::automatic).report().is_exact);
  EXPECT_FALSE(solved(scene, 0.1, ReflectedVisibility::sampled).report().is_exact);
  EXPECT_FALSE(solved(plates(0.3, 0.5), 0.1, ReflectedVisibility::automatic).report().is_exact)
      << "little of it comes back";
}

/// Rays took less than a quarter of the time in the first three rooms, four times as long in the
/// others.
TEST(ReflectedCost, WaitsForExactPartsInSmallRoomsAlone) {
  const auto is_exact = [](int surfaces, double tolerance) {
    ReflectedOptions options;
    options.tolerance = tolerance;
    return reflected_cost(surfaces, options).is_exact;
  };
  EXPECT_FALSE(is_exact(72, 0.005));
  EXPECT_FALSE(is_exact(59, 0.005)) << "though that is less than two and a half times as long";
  EXPECT_FALSE(is_exact(276, 0.01));
  EXPECT_TRUE(is_exact(17, 0.005));
  EXPECT_TRUE(is_exact(9, 0.002));
}

TEST(AmplifiedLight, ExactPartsAreWorthLessAmongManySurfaces) {
  ReflectedOptions options;
  options.tolerance = 0.1;
  EXPECT_LT(reflected_cost(2, options).give_up.amplified, 20);
  EXPECT_GT(reflected_cost(1000, options).give_up.amplified, 1000);
  options.visibility = ReflectedVisibility::sampled;
  EXPECT_EQ(reflected_cost(2, options).give_up.amplified, HUGE_VAL);
}

}  // namespace
}  // namespace halfshade
