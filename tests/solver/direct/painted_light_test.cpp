#include "solver/direct/painted_light.h"

#include "tests/support/gauss_rule.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const SurfacePoint beside{{0.8, 0.3, 0}, Vec3::UnitZ()};

/// What of the light of S1 is visible from `beside`, as two rectangles: the occluder covers
/// [−1.55, −0.05] × [−1.05, 0.45] of the light's plane.
constexpr double visible_rectangles[2][4] = {{-0.05, 0.5, -0.5, 0.5}, {-0.5, -0.05, 0.45, 0.5}};

/// ∫ E K over the visible rectangles by a tensor rule of 256 nodes each.
template <class Paint>
double by_tensor_rule(Paint paint) {
  double sum = 0;
  for (const auto& r : visible_rectangles)
    for (const test::LineNode& u : test::gauss_rule(16))
      for (const test::LineNode& v : test::gauss_rule(16)) {
        const double x = r[0] + u.x * (r[1] - r[0]), y = r[2] + v.x * (r[3] - r[2]);
        const double dx = x - 0.8, dy = y - 0.3, r2 = dx * dx + dy * dy + 4;
        sum += u.weight * v.weight * (r[1] - r[0]) * (r[3] - r[2]) * paint(x, y) * 4 /
               (M_PI * r2 * r2);
      }
  return sum;
}

PaintedLight with_paint(const ExitanceAt& paint, double tolerance) {
  const SoundScene scene = test::s1();
  return painted_irradiance(DirectLightIndex(scene), scene, beside, 0, paint, {tolerance, 100000});
}

TEST(PaintedLight, OfOneColourIsExactAtOnce) {
  const PaintedLight light = with_paint([](const Vec3&) { return Rgb(2, 3, 0); }, 1e-12);
  const double factor = by_tensor_rule([](double, double) { return 1; });
  EXPECT_NEAR(light.irradiance[0], 2 * factor, 1e-15);
  EXPECT_NEAR(light.irradiance[1], 3 * factor, 1e-15);
  EXPECT_EQ(light.irradiance[2], 0);
  EXPECT_LT(light.triangles, 20);
}

TEST(PaintedLight, OfSmoothPaintMatchesAHighOrderRule) {
  const auto paint = [](double x, double y) { return 1.5 + std::sin(5 * x) * std::cos(3 * y + 1); };
  const double want = by_tensor_rule(paint);
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    const PaintedLight light = with_paint(
        [&](const Vec3& q) { return Rgb::Constant(paint(q.x(), q.y())).eval(); }, tolerance);
    EXPECT_TRUE(light.converged);
    EXPECT_NEAR(light.irradiance[0], want, tolerance * want) << light.triangles << " triangles";
    EXPECT_LE(light.error, tolerance * want * (1 + tolerance));
  }
}

TEST(PaintedLight, OfStripesApproachesTheSumOfTheStripes) {
  // Light where x > 0.2, dark elsewhere: a break that triangles have to close in on.
  const double bright = [] {
    double sum = 0;
    for (const test::LineNode& u : test::gauss_rule(16))
      for (const test::LineNode& v : test::gauss_rule(16)) {
        const double x = 0.2 + 0.3 * u.x, y = -0.5 + v.x;
        const double dx = x - 0.8, dy = y - 0.3, r2 = dx * dx + dy * dy + 4;
        sum += u.weight * v.weight * 0.3 * 4 / (M_PI * r2 * r2);
      }
    return sum;
  }();
  const PaintedLight light =
      with_paint([](const Vec3& q) { return Rgb::Constant(q.x() > 0.2 ? 1. : 0.).eval(); }, 1e-3);
  EXPECT_NEAR(light.irradiance[0], bright, 2e-3 * bright);
}

TEST(PaintedLight, AsksForPaintOnTheVisiblePartOnly) {
  with_paint(
      [](const Vec3& q) {
        EXPECT_LE(std::abs(q.x()), 0.5 + 1e-12);
        EXPECT_LE(std::abs(q.y()), 0.5 + 1e-12);
        EXPECT_EQ(q.z(), 2);
        EXPECT_TRUE(q.x() >= -0.05 - 1e-12 || q.y() >= 0.45 - 1e-12) << q.transpose();
        return Rgb(1 + q.x(), 1, 1);
      },
      1e-6);
}

TEST(PaintedLight, SaysSoIfTheBudgetIsTooSmall) {
  const SoundScene scene = test::s1();
  const PaintedLight light = painted_irradiance(
      DirectLightIndex(scene), scene, beside, 0,
      [](const Vec3& q) { return Rgb::Constant(1 + std::sin(100 * q.x())).eval(); }, {1e-9, 50});
  EXPECT_FALSE(light.converged);
  EXPECT_LE(light.triangles, 50);
}

TEST(PaintedLight, InUmbraIsZero) {
  const SoundScene scene = test::s1();
  const PaintedLight light =
      painted_irradiance(DirectLightIndex(scene), scene, {{0.1, 0, 0}, Vec3::UnitZ()}, 0,
                         [](const Vec3&) { return Rgb(1, 1, 1); });
  EXPECT_TRUE((light.irradiance == 0).all());
  EXPECT_TRUE(light.converged);
}

}  // namespace
}  // namespace halfshade
