#include "solver/direct/direct_light.h"

#include "tests/support/analytic.h"
#include "tests/support/expect_error.h"
#include "tests/support/sound_scenes.h"
#include "tests/support/visibility_oracle.h"

#include <gtest/gtest.h>

#include <limits>

namespace halfshade {
namespace {

using test::Random;

const Vec3 up = Vec3::UnitZ();

/// S1 in closed form: the light less what the occluder covers of it; see data/s1.md.
double s1_form_factor(double x, double y) {
  const double light = test::point_parallel_rectangle(-0.5 - x, 0.5 - x, -0.5 - y, 0.5 - y, 2);
  const auto cut = [](double v) { return std::clamp(v, -0.5, 0.5); };
  const double x0 = cut(-0.75 - x), x1 = cut(0.75 - x), y0 = cut(-0.75 - y), y1 = cut(0.75 - y);
  return light - test::point_parallel_rectangle(x0 - x, x1 - x, y0 - y, y1 - y, 2);
}

TEST(DirectLight, HasTheKnownValuesOfS1) {
  const DirectLightIndex index(test::s1());
  ASSERT_EQ(index.emitters().size(), 1u);
  const auto at = [&](double x, double y) { return index.factor({{x, y, 0}, up}, 0).visible; };
  EXPECT_NEAR(at(0.5, 0), 0.018916915317, 1e-12);
  EXPECT_NEAR(at(0.75, 0.3), 0.033762803811, 1e-12);
  EXPECT_NEAR(at(1.25, 0), 0.040681704379, 1e-12);
  EXPECT_NEAR(at(1.5, 0.2), 0.032271304623, 1e-12);
  EXPECT_EQ(at(0, 0), 0);
}

TEST(DirectLight, MatchesTheClosedFormOfS1Everywhere) {
  const DirectLightIndex index(test::s1());
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double x = random(-1.9, 1.8), y = random(-1.9, 1.8);
    const PointFactor factor = index.factor({{x, y, 0}, up}, 0);
    EXPECT_NEAR(factor.visible, s1_form_factor(x, y), 2e-16) << x << " " << y;
    const double far = std::max(std::abs(x), std::abs(y));
    EXPECT_EQ(factor.region, far < 0.25   ? Region::umbra
                             : far < 1.25 ? Region::penumbra
                                          : Region::lit)
        << x << " " << y;
    if (far < 0.25) {
      EXPECT_EQ(factor.visible, 0);
    }
    if (far > 1.25) {
      EXPECT_EQ(factor.visible, factor.unobstructed);
    }
  }
}

TEST(DirectLight, IsZeroBehindAndBelow) {
  const DirectLightIndex index(test::s1());
  for (const SurfacePoint& point :
       {SurfacePoint{{0.3, 0.2, 3}, -up}, SurfacePoint{{0.3, 0.2, 3}, up},
        SurfacePoint{{0.3, 0.2, 0}, -up}, SurfacePoint{{0.3, 0.2, 2}, -up},
        SurfacePoint{{0.6, 0.2, 2}, up}}) {
    const PointFactor factor = index.factor(point, 0);
    EXPECT_EQ(factor.region, Region::away);
    EXPECT_EQ(factor.visible, 0);
    EXPECT_EQ(factor.unobstructed, 0);
    const DirectLight light = index.irradiance(std::vector{point})[0];
    EXPECT_EQ(light.visible, 1) << "no emitter above the horizon";
    EXPECT_TRUE((light.irradiance == 0).all());
  }
}

TEST(DirectLight, KeepsItsDigitsForTinyLights) {
  // A light of 2^-20 at distance 2: cos cos' / (π r²) times its area, to second order in the size.
  const double s = 0x1p-20;
  SoundScene scene = test::empty_sound_scene(4);
  test::add_surface(scene, {{{-s, -s, 2}, {-s, s, 2}, {s, s, 2}, {s, -s, 2}}}, 1);
  const DirectLightIndex index(scene);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0.5, 0), Vec3(3, -2, 1)}) {
    const double r2 = p.x() * p.x() + p.y() * p.y() + (2 - p.z()) * (2 - p.z());
    const double want = 4 * s * s * (2 - p.z()) * (2 - p.z()) / (M_PI * r2 * r2);
    EXPECT_NEAR(index.factor({p, up}, 0).visible, want, 1e-11 * want);
    EXPECT_NEAR(index.factor({p, up}, 0).visible,
                static_cast<double>(test::VisibilityOracle(scene).form_factor(p, up, 0).visible),
                1e-12 * want)
        << "long double, too, has only five digits to spare here";
  }
}

TEST(DirectLight, ComesCloseToOneRightUnderTheLight) {
  const DirectLightIndex index(test::s1());
  for (const double gap : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const double want = 4 * test::point_parallel_rectangle(0.5, 0.5, gap);
    EXPECT_NEAR(index.factor({{0, 0, 2 - gap}, up}, 0).visible, want, 1e-15);
  }
}

TEST(DirectLight, OccluderOnTheFloorShadesWhatItCovers) {
  // D0: the light breaks off at the foot of a wall that stands on the floor.
  SoundScene scene = test::empty_sound_scene(6);
  test::add_surface(scene, {{{1, -1, 2}, {1, 1, 2}, {3, 1, 2}, {3, -1, 2}}}, 1);
  test::add_surface(scene, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}, 0);
  test::add_surface(scene, {{{0, -3, 0}, {0, 3, 0}, {0, 3, 4}, {0, -3, 4}}}, 0);
  const DirectLightIndex index(scene);
  EXPECT_EQ(index.factor({{-1e-12, 0.2, 0}, up}, 0).region, Region::umbra);
  EXPECT_EQ(index.factor({{1e-12, 0.2, 0}, up}, 0).region, Region::lit);
}

TEST(DirectLight, AddsUpColouredLightsAndWeighsTheVisibleShare) {
  // Two lights side by side; a wall between them and the point hides the second only.
  SoundScene scene = test::empty_sound_scene(6);
  Material red, blue;
  red.exitance = {6, 0, 0};
  blue.exitance = {0, 0, 3};
  scene.materials.insert(scene.materials.end(), {red, blue});
  const auto square = [](double x, double z, double h) {
    return std::vector<Vec3>{{x - h, -h, z}, {x - h, h, z}, {x + h, h, z}, {x + h, -h, z}};
  };
  test::add_surface(scene, {square(-1, 2, 0.5)}, 2);
  test::add_surface(scene, {square(1, 2, 0.5)}, 3);
  test::add_surface(scene, {square(0.5, 1, 0.4)}, 0);
  const DirectLightIndex index(scene);
  const DirectLight light = index.irradiance(std::vector{SurfacePoint{{0, 0, 0}, up}})[0];
  const double each = test::point_parallel_rectangle(0.5, 1.5, -0.5, 0.5, 2);
  EXPECT_NEAR(light.irradiance[0], 6 * each, 1e-15);
  EXPECT_EQ(light.irradiance[1], 0);
  EXPECT_LT(light.irradiance[2], 1e-2 * 3 * each);
  EXPECT_NEAR(light.visible, (2 * each + light.irradiance[2] / 3) / (3 * each), 1e-14);
  EXPECT_EQ(light.region, Region::lit) << "with respect to the stronger light";
}

TEST(DirectLight, RefusesSurfacesThatDoNotExist) {
  const DirectLightIndex index(test::s1());
  for (const int id : {-1, 3}) EXPECT_THROW(index.factor({{0, 0, 0}, up}, id), Error) << id;
}

/// The same scene with its points moved.
template <class Move>
SoundScene moved(const SoundScene& scene, double size, Move move) {
  SoundScene result = test::empty_sound_scene(size);
  for (const Surface& surface : scene.surfaces) {
    std::vector<std::vector<Vec3>> rings;
    for (const Ring& ring : surface.rings) {
      rings.emplace_back();
      for (const Vec2& p : ring) rings.back().push_back(move(surface.frame.to_space(p)));
    }
    test::add_surface(result, rings, surface.material);
  }
  return result;
}

SoundScene cluttered(std::uint64_t seed) {
  Random random(seed);
  SoundScene scene = test::empty_sound_scene(6);
  test::add_surface(scene, {{{-1, -1, 2.5}, {-1, 1, 2.5}, {1, 1, 2.5}, {1, -1, 2.5}}}, 1);
  for (int k = 0; k < 10; ++k)
    test::add_surface(scene,
                      {test::random_polygon(random, random.in_box({-1.5, -1.5, 0.6}, {1.5, 1.5, 2}),
                                            random.direction(), random(0.1, 0.5))},
                      0);
  return scene;
}

/// Largest change relative to the unobstructed value over random points.
template <class Move, class Turn>
double largest_change(double size, Move move, Turn turn) {
  double largest = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const SoundScene scene = cluttered(seed);
    const DirectLightIndex before(scene), after(moved(scene, size, move));
    Random random(seed + 10);
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = random.in_box({-2, -2, 0}, {2, 2, 0.3});
      const PointFactor a = before.factor({p, up}, 0);
      const PointFactor b = after.factor({move(p), turn(up)}, 0);
      largest = std::max(largest, std::abs(a.visible - b.visible) / a.unobstructed);
    }
  }
  return largest;
}

TEST(DirectLight, PointsOnASlantedSurfaceAreNotShadedByIt) {
  // Rounding puts the points a hair in front of the floor or behind it.
  Random random(8);
  for (int scene = 0; scene < 10; ++scene) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(random(0, 6), random.direction()));
    const Vec3 shift = random.in_box(Vec3::Constant(-10), Vec3::Constant(10));
    const auto move = [&](const Vec3& p) -> Vec3 { return turn * p + shift; };
    const SoundScene turned = moved(test::s1(), 10, move);
    const DirectLightIndex index(turned);
    for (int k = 0; k < 200; ++k) {
      const double x = random(-1.9, 1.8), y = random(-1.9, 1.8);
      const PointFactor factor =
          index.factor({move({x, y, 0}), turned.surfaces[2].frame.normal}, 0);
      EXPECT_NEAR(factor.visible, s1_form_factor(x, y), 1e-14) << x << " " << y;
    }
  }
}

// The bounds: coordinates rounded relatively by ε = 1.1e-16 of the largest move the projection of
// an occluder's edge by that times the ratio of distances (here at most 5), and the light changes
// in proportion to the length of the edges (a few hundred times less than 1e4).
constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;

TEST(DirectLight, DoesNotChangeWhenTheSceneIsTurned) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  const auto move = [&](const Vec3& p) -> Vec3 { return turn * p; };
  EXPECT_LT(largest_change(6, move, move), 1000 * epsilon);
}

TEST(DirectLight, DoesNotChangeWhenTheSceneIsScaled) {
  for (const double factor : {1e-6, 1e6, 0x1p40})
    EXPECT_LT(largest_change(
                  6 * factor, [&](const Vec3& p) -> Vec3 { return factor * p; },
                  [](const Vec3& n) { return n; }),
              1000 * epsilon)
        << factor;
}

TEST(DirectLight, LosesOnlyWhatRoundingTakesWhenTheSceneIsFarAway) {
  // Moved by a million times its size, its coordinates are rounded by 6e6 ε ≈ 7e-10.
  const Vec3 shift(6e6, -6e6, 6e6);
  EXPECT_LT(
      largest_change(
          6, [&](const Vec3& p) -> Vec3 { return p + shift; }, [](const Vec3& n) { return n; }),
      100 * 6e6 * epsilon);
}

TEST(ElementDirectLight, IsTheMeanOverTheElement) {
  // Lit elements of S1, whose mean is known from the exact form factor between rectangles.
  const SoundScene scene = test::s1();
  ElementTable elements;
  elements.points = {{1.3, -0.2, 0}, {1.7, -0.2, 0}, {1.7, 0.2, 0}, {1.3, 0.2, 0}};
  elements.corners = {{0, 1, 2}, {0, 2, 3}};
  elements.normal = {up, up};
  elements.surface = {2, 2};
  const auto mean_with = [&](int points) {
    return irradiance_of(element_direct_light(scene, elements, DirectLightIndex(scene), points),
                         scene);
  };
  const ChannelArray mean = mean_with(12);
  const double want =
      test::offset_parallel_rectangles({1.3, 1.7}, {-0.2, 0.2}, {-0.5, 0.5}, {-0.5, 0.5}, 2);
  EXPECT_NEAR(mean.col(0).mean(), want, 1e-9);
  const ChannelArray coarse = mean_with(1);
  EXPECT_NEAR(coarse.col(0).mean(), want, 1e-3);
  EXPECT_GT(std::abs(coarse.col(0).mean() - want), 1e-7);
}

TEST(ElementDirectLight, NamesTheRegionOfEachElement) {
  const SoundScene scene = test::s1();
  ElementTable elements;
  elements.points = {{-.1, 0, 0}, {.1, 0, 0},  {0, .1, 0},    // umbra: |x|, |y| < .25
                     {.5, 0, 0},  {.7, 0, 0},  {.6, .1, 0},   // penumbra
                     {1.4, 0, 0}, {1.6, 0, 0}, {1.5, .1, 0},  // lit: |x| > 1.25
                     {.2, 0, 0},  {.4, 0, 0},  {.3, .1, 0}};  // partly umbra
  elements.corners = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
  elements.normal = {up, up, up, up};
  elements.surface = {2, 2, 2, 2};
  const ElementDirectLight light =
      element_direct_light(scene, elements, DirectLightIndex(scene), 6);
  EXPECT_EQ(light.region,
            (std::vector<Region>{Region::umbra, Region::penumbra, Region::lit, Region::penumbra}));
  EXPECT_EQ(light.factor(0, 0), 0);
}

TEST(ElementDirectLight, OfALightUnderItselfIsZero) {
  const SoundScene scene = test::s1();
  ElementTable elements;
  elements.points = {{-0.5, -0.5, 2}, {-0.5, 0.5, 2}, {0.5, 0.5, 2}};
  elements.corners = {{0, 1, 2}};
  elements.normal = {-up};
  elements.surface = {0};
  const ElementDirectLight light =
      element_direct_light(scene, elements, DirectLightIndex(scene), 3);
  EXPECT_TRUE((light.factor == 0).all());
  EXPECT_EQ(light.region, std::vector<Region>{Region::away});
}

}  // namespace
}  // namespace halfshade
