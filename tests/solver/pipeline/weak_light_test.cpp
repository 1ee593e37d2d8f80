#include "solver/pipeline/weak_light.h"

#include "solver/direct/direct_light.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A hall with 6 × 6 lamps of 0.5 × 0.5 at z = 3 over 12 × 12 boxes of different heights on a
/// floor.
Scene hall_of_boxes() {
  test::SceneMaker maker;
  maker.up({0, 0}, {12, 12}, 0);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      maker.down({2. * i + 0.75, 2. * j + 0.75}, {2. * i + 1.25, 2. * j + 1.25}, 3,
                 test::white_light);
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      maker.standing_box({i + 0.31, j + 0.27, 0},
                         {i + 0.83, j + 0.74, 0.2 + 0.1 * ((5 * i + 7 * j) % 11)});
  return maker.scene;
}

struct Sample {
  FieldPoint point;
  double exact;
};

std::vector<Sample> samples(const PreparedScene& prepared) {
  std::vector<Sample> result;
  const std::vector<Surface>& surfaces = prepared.scene().surfaces;
  for (std::size_t s = 0; s < surfaces.size() && surfaces[s].rings.size() == 1; s += 3) {
    const Ring& ring = surfaces[s].rings.front();
    const Vec2 middle = (0.6 * ring[0] + 0.4 * ring[2]);
    const FieldPoint point{{surfaces[s].frame.to_space(middle), surfaces[s].frame.normal},
                           static_cast<int>(s)};
    result.push_back({point, prepared.direct_light().irradiance(point.point).irradiance[0]});
  }
  return result;
}

TEST(WeakLight, IsWithinItsNoiseAndExactWithoutAny) {
  const PreparedScene prepared(hall_of_boxes());
  const std::vector<Sample> all = samples(prepared);
  ASSERT_GT(all.size(), 200U);
  double mean = 0;
  for (const Sample& sample : all) mean += sample.exact / static_cast<double>(all.size());
  ASSERT_GT(mean, 0);
  for (const double noise : {0., 0.01 * mean, 0.05 * mean}) {
    const WeakLight light(prepared, std::sqrt(3.) * noise);
    double square = 0, sum = 0;
    for (const Sample& sample : all) {
      const double off = light.irradiance(sample.point).irradiance[0] - sample.exact;
      square += off * off / static_cast<double>(all.size());
      sum += off / static_cast<double>(all.size());
    }
    EXPECT_LE(std::sqrt(square), noise + 1e-12 * mean);
    EXPECT_LE(std::abs(sum), 0.3 * noise + 1e-12 * mean);
    // Rays were cast at all.
    EXPECT_EQ(square > 1e-20 * mean * mean, noise > 0);
  }
}

TEST(WeakLight, IsTheSameForTheSamePoint) {
  const PreparedScene prepared(hall_of_boxes());
  const WeakLight light(prepared, 1);
  for (const Sample& sample : samples(prepared))
    EXPECT_TRUE(
        (light.irradiance(sample.point).irradiance == light.irradiance(sample.point).irradiance)
            .all());
}

TEST(WeakLight, PaysAmongManySurfacesAndSeveralLights) {
  const PreparedScene few(hall_of_boxes());
  EXPECT_FALSE(has_weak_light(few.scene()));
}

}  // namespace
}  // namespace halfshade
