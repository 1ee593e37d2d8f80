#include "io/read/read_scene.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/analytic.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace halfshade {
namespace {

const Vec3 up = Vec3::UnitZ();

SoundScene load(const std::string& name) {
  return make_sound(read_scene(test::data_file(name + ".obj")).scene);
}

using Intervals = std::vector<std::array<double, 2>>;

/// What the bars of bars.md at height h leave of [−0.5, 0.5], seen from x on the floor.
Intervals gaps(double x, double h) {
  const auto seen = [&](double u) { return std::clamp(x + 3 / h * (u - x), -0.5, 0.5); };
  Intervals result;
  double from = -0.5;
  for (int bar = 0; bar < 8; ++bar) {
    const double centre = -0.7 + 0.2 * bar;
    result.push_back({from, std::max(from, seen(centre - 0.05))});
    from = std::max(from, seen(centre + 0.05));
  }
  result.push_back({from, 0.5});
  return result;
}

TEST(DirectLightScenes, BarsLeaveAProductOfGaps) {
  const DirectLightIndex index(load("bars"));
  ASSERT_EQ(index.emitters().size(), 1u);
  int compared = 0;
  for (double x = -0.9; x <= 0.9; x += 0.0731)
    for (double y = -0.9; y <= 0.9; y += 0.0917) {
      double want = 0;
      for (const auto& u : gaps(x, 1.5))
        for (const auto& v : gaps(y, 1.6))
          if (u[1] > u[0] && v[1] > v[0])
            want += test::point_parallel_rectangle(u[0] - x, u[1] - x, v[0] - y, v[1] - y, 3);
      EXPECT_NEAR(index.factor({{x, y, 0}, up}, index.emitters()[0]).visible, want, 1e-15)
          << x << " " << y;
      ++compared;
    }
  EXPECT_GT(compared, 400);
}

/// The quadric of skew_bars.md.
double concurrence(const Vec3& x) {
  Eigen::Matrix3d n;
  n.col(0) = (Vec3(0, 0, 1) - x).cross(Vec3(1, 1, 0));
  n.col(1) = (Vec3(0.1, 0, 0.75) - x).cross(Vec3(1, -1, 0.1));
  n.col(2) = (Vec3(0, 0.5, 2) - x).cross(Vec3(1, 0, 0));
  return n.determinant();
}

TEST(DirectLightScenes, UmbraOfSkewBarsEndsAtTheConic) {
  const DirectLightIndex index(load("skew_bars"));
  const int light = index.emitters()[0];
  int found = 0;
  for (double y = -0.34; y < -0.275; y += 0.01) {
    // Bisection for the end of the umbra knows nothing of the conic.
    double dark = 0, lit = 0.3;
    ASSERT_EQ(index.factor({{dark, y, 0}, up}, light).region, Region::umbra) << y;
    ASSERT_EQ(index.factor({{lit, y, 0}, up}, light).region, Region::penumbra) << y;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (dark + lit);
      (index.factor({{middle, y, 0}, up}, light).region == Region::umbra ? dark : lit) = middle;
    }
    EXPECT_NEAR(concurrence({dark, y, 0}), 0, 1e-14) << dark << " " << y;
    EXPECT_GT(std::abs(concurrence({dark + 1e-3, y, 0})), 1e-5);
    ++found;
  }
  EXPECT_GE(found, 6);
}

TEST(DirectLightScenes, SkewBarsHaveTheTabulatedJump) {
  const DirectLightIndex index(load("skew_bars"));
  const int light = index.emitters()[0];
  EXPECT_EQ(index.factor_derivatives({{0.1 - 1e-6, -0.3, 0}, up}, light).hessian(0, 0), 0);
  EXPECT_NEAR(index.factor_derivatives({{0.1 + 1e-6, -0.3, 0}, up}, light).hessian(0, 0),
              1.339969e-2, 1e-5);
}

TEST(DirectLightScenes, SphereCoversItsCone) {
  const DirectLightIndex index(load("sphere"));
  const PointFactor factor = index.factor({{0, 0, 0}, up}, index.emitters()[0]);
  const double light = test::point_parallel_rectangle(-1, 1, -1, 1, 3);
  EXPECT_NEAR(factor.unobstructed, light, 1e-15);
  EXPECT_GT(light - factor.visible, 0.99943 / 16);
  EXPECT_LT(light - factor.visible, 1. / 16);
}

TEST(DirectLightScenes, LightWithAHoleIsTheSumOfItsRectangles) {
  const SoundScene scene = load("holed_light");
  const DirectLightIndex index(scene);
  ASSERT_EQ(index.emitters().size(), 1u) << "merged into one surface";
  EXPECT_EQ(scene.surfaces[static_cast<std::size_t>(index.emitters()[0])].rings.size(), 2u);
  constexpr double rectangles[6][4] = {{-1, -.5, -1, 0},   {-.5, .5, -1, -.75}, {.5, 1, -1, 0},
                                       {-.5, .5, -.25, 0}, {-1, -.5, 0, 1},     {-.5, 0, .75, 1}};
  for (const auto& [x, y] : {std::pair(1.9, -1.9), std::pair(0.02, 0.01), std::pair(-1.1, 0.3)}) {
    double want = 0;
    for (const auto& r : rectangles)
      want += test::point_parallel_rectangle(r[0] - x, r[1] - x, r[2] - y, r[3] - y, 2.5);
    const PointFactor factor = index.factor({{x, y, 0}, up}, index.emitters()[0]);
    EXPECT_NEAR(factor.unobstructed, want, 2e-15);
  }
  EXPECT_EQ(index.factor({{1.9, -1.9, 0}, up}, index.emitters()[0]).region, Region::lit);
  EXPECT_EQ(index.factor({{0.02, 0.01, 0}, up}, index.emitters()[0]).region, Region::penumbra);
}

TEST(DirectLightScenes, HundredLightsStayBelowTheirSum) {
  const DirectLightIndex index(load("hundred_lights"));
  ASSERT_EQ(index.emitters().size(), 100u);
  int shaded = 0;
  for (int k = 0; k < 20; ++k) {
    const double x = -5.3 + 0.53 * k, y = 4.9 - 0.47 * k;
    double whole = 0;
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j) {
        const double u = -5.4 + 1.2 * i - x, v = -5.4 + 1.2 * j - y;
        whole += test::point_parallel_rectangle(u - 0.15, u + 0.15, v - 0.15, v + 0.15, 4);
      }
    const DirectLight light = index.irradiance(SurfacePoint{{x, y, 0}, up});
    EXPECT_LT(light.irradiance[0], whole);
    EXPECT_NEAR(light.irradiance[0], light.visible * whole, 1e-13);
    if (light.visible < 0.98) ++shaded;
  }
  EXPECT_GT(shaded, 10);
}

}  // namespace
}  // namespace halfshade
