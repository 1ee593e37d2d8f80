#include "solver/direct/direct_light.h"
#include "tests/support/allocations.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

namespace halfshade {
namespace {

using test::Random;

/// Boxes and polygons under two lights, one of them with a hole.
SoundScene scene_with_lights() {
  Random random(5);
  SoundScene scene = test::empty_sound_scene(6);
  test::add_surface(scene, {{{-2, -1, 2.5}, {-2, 1, 2.5}, {-0.5, 1, 2.5}, {-0.5, -1, 2.5}}}, 1);
  test::add_surface(scene,
                    {{{0, -1, 2.5}, {0, 1, 2.5}, {2, 1, 2.5}, {2, -1, 2.5}},
                     {{0.5, -0.5, 2.5}, {1.5, -0.5, 2.5}, {1.5, 0.5, 2.5}, {0.5, 0.5, 2.5}}},
                    1);
  test::add_surface(scene, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}, 0);
  for (int k = 0; k < 4; ++k)
    for (const auto& face :
         test::random_box(random, random.in_box({-1.5, -1.5, 0.6}, {1.5, 1.5, 1.8}), 0.4))
      test::add_surface(scene, {face}, 0);
  return scene;
}

std::vector<SurfacePoint> random_points(std::size_t count) {
  Random random(6);
  std::vector<SurfacePoint> points(count);
  for (SurfacePoint& p : points)
    p = {random.in_box({-3, -3, 0}, {3, 3, 0}), Vec3(random(-1, 1), random(-1, 1), 1).normalized()};
  return points;
}

TEST(DirectLightBatch, AllocatesNothingPerPointInTheSteadyState) {
  if (!test::counts_allocations) GTEST_SKIP() << "a sanitizer allocates";
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const DirectLightIndex index(scene_with_lights());
  const std::vector<SurfacePoint> points = random_points(4096);
  index.irradiance(points);  // buffers grow
  const auto count = [&](std::size_t n) {
    const std::size_t before = test::allocations();
    index.irradiance(std::span(points).first(n));
    return test::allocations() - before;
  };
  const std::size_t few = count(64), many = count(4096);
  EXPECT_LE(many, few + 64 * 2) << "a task of 64 points may cost something, a point nothing";
  const std::size_t before = test::allocations();
  double sum = 0;
  for (const SurfacePoint& p : points) sum += index.factor(p, 0).visible;
  EXPECT_EQ(test::allocations() - before, 0u);
  EXPECT_GT(sum, 0);
}

TEST(DirectLightBatch, CountsAllocationsAtAll) {
  if (!test::counts_allocations) GTEST_SKIP() << "a sanitizer allocates";
  const std::size_t before = test::allocations();
  const DirectLightIndex index(scene_with_lights());
  EXPECT_GT(test::allocations() - before, 10u);
}

TEST(DirectLightBatch, ThreadsAndOrderDoNotChangeABit) {
  const SoundScene scene = scene_with_lights();
  const std::vector<SurfacePoint> points = random_points(1000);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return DirectLightIndex(scene).irradiance(points);
  };
  const auto one = run(1), two = run(2);
  const DirectLightIndex index(scene);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_TRUE((one[k].irradiance == two[k].irradiance).all());
    EXPECT_EQ(one[k].visible, two[k].visible);
    EXPECT_EQ(one[k].region, two[k].region);
    // Backwards, with a finder that has seen other points before.
    const std::size_t j = points.size() - 1 - k;
    EXPECT_TRUE((index.irradiance(points[j]).irradiance == one[j].irradiance).all());
  }
}

/// Lamps over so many boxes that points look through them together.
SoundScene scene_with_many_boxes() {
  Random random(15);
  SoundScene scene = test::empty_sound_scene(6);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double x = 2 * i - 2.2, y = 2 * j - 2.2;
      test::add_surface(scene,
                        {{{x, y, 3}, {x, y + 0.4, 3}, {x + 0.4, y + 0.4, 3}, {x + 0.4, y, 3}}}, 1);
    }
  // One that stands upright, and one that boxes reach through.
  test::add_surface(scene, {{{-3, -1, 1}, {-3, 1, 1}, {-3, 1, 2}, {-3, -1, 2}}}, 1);
  test::add_surface(scene, {{{-1, -1, 1.2}, {-1, 1, 1.2}, {1, 1, 1.2}, {1, -1, 1.2}}}, 1);
  test::add_surface(scene, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}, 0);
  for (int k = 0; k < 60; ++k)
    for (const auto& face :
         test::random_box(random, random.in_box({-2.5, -2.5, 0.4}, {2.5, 2.5, 2.6}), 0.25))
      test::add_surface(scene, {face}, 0);
  return scene;
}

TEST(DirectLightBatch, SizeAndOrderOfBatchesDoNotChangeABit) {
  const DirectLightIndex index(scene_with_many_boxes());
  std::vector<SurfacePoint> points = random_points(600);
  // Close together, and all in one place.
  Random random(16);
  for (int k = 0; k < 100; ++k)
    points.push_back({random.in_box({0.2, 0.2, 0}, {0.3, 0.3, 0}), Vec3::UnitZ()});
  points.insert(points.end(), 20, points.back());
  // In the planes of lamps.
  for (int k = 0; k < 50; ++k)
    points.push_back({random.in_box({-3, -3, 1.2}, {3, 3, 1.2}), Vec3::UnitZ()});
  std::vector<DirectLight> alone;
  for (const SurfacePoint& p : points) alone.push_back(index.irradiance(p));
  int penumbras = 0;
  for (const std::size_t size : {std::size_t{7}, std::size_t{64}, points.size()})
    for (const bool backwards : {false, true})
      for (std::size_t first = 0; first < points.size(); first += size) {
        std::vector<SurfacePoint> some(
            points.begin() + static_cast<std::ptrdiff_t>(first),
            points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), first + size)));
        if (backwards) std::reverse(some.begin(), some.end());
        const auto light = index.irradiance(some);
        for (std::size_t k = 0; k < some.size(); ++k) {
          const DirectLight& one = alone[first + (backwards ? some.size() - 1 - k : k)];
          ASSERT_TRUE((light[k].irradiance == one.irradiance).all()) << size << ' ' << first + k;
          ASSERT_EQ(light[k].visible, one.visible);
          ASSERT_EQ(light[k].region, one.region);
          ASSERT_EQ(light[k].crowd_work, one.crowd_work);
          ASSERT_EQ(light[k].effort.looks, one.effort.looks);
          ASSERT_EQ(light[k].effort.turns, one.effort.turns);
          ASSERT_EQ(light[k].effort.boxes, one.effort.boxes);
          penumbras += one.visible > 0 && one.visible < 1 ? 1 : 0;
        }
      }
  EXPECT_GT(penumbras, 1000);
}

TEST(DirectLightBatch, IsTheSumOverTheEmitters) {
  const DirectLightIndex index(scene_with_lights());
  ASSERT_EQ(index.emitters().size(), 2u);
  const std::vector<SurfacePoint> points = random_points(300);
  const auto light = index.irradiance(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const PointFactor a = index.factor(points[k], 0), b = index.factor(points[k], 1);
    EXPECT_EQ(light[k].irradiance[0], a.visible + b.visible);
    if (a.unobstructed + b.unobstructed > 0) {
      EXPECT_EQ(light[k].visible, (a.visible + b.visible) / (a.unobstructed + b.unobstructed));
      EXPECT_EQ(light[k].region, a.unobstructed >= b.unobstructed ? a.region : b.region);
    }
  }
}

TEST(DirectLightBatch, StopsWhenAskedTo) {
  const DirectLightIndex index(scene_with_lights());
  std::stop_source stop;
  stop.request_stop();
  Progress progress;
  progress.stop = stop.get_token();
  const auto light = index.irradiance(random_points(500), progress);
  ASSERT_EQ(light.size(), 500u);
  for (const DirectLight& l : light) EXPECT_TRUE((l.irradiance == 0).all());
}

TEST(DirectLightBatch, OfAHundredThousandRandomFacesIsFiniteAndInBounds) {
  Random random(7);
  SoundScene scene = test::empty_sound_scene(20);
  test::add_surface(scene, {{{-2, -2, 5}, {-2, 2, 5}, {2, 2, 5}, {2, -2, 5}}}, 1);
  for (int k = 0; k < 100000; ++k) {
    // Planes are all different; looking for equal ones would take quadratic time.
    SoundScene one = test::empty_sound_scene(20);
    const Vec3 centre = random.in_box({-8, -8, 0.5}, {8, 8, 4.5});
    test::add_surface(one, {test::random_polygon(random, centre, random.direction(), 0.02)}, 0);
    one.surfaces[0].plane = k + 1;
    scene.surfaces.push_back(one.surfaces[0]);
  }
  const DirectLightIndex index(scene);
  int regions[4] = {};
  for (int k = 0; k < 12; ++k) {
    const SurfacePoint point{random.in_box({-8, -8, 0}, {8, 8, 0}), Vec3::UnitZ()};
    const PointFactor factor = index.factor(point, 0);
    ++regions[static_cast<int>(factor.region)];
    EXPECT_TRUE(std::isfinite(factor.visible));
    EXPECT_GE(factor.visible, 0);
    EXPECT_LE(factor.visible, factor.unobstructed);
    EXPECT_LE(factor.unobstructed, 1);
  }
  EXPECT_GT(regions[static_cast<int>(Region::penumbra)], 6);
}

}  // namespace
}  // namespace halfshade
