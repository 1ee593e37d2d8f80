#include "solver/direct/ray_emitter.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/geometry/spread_pairs.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A triangle, whose centroid is not the middle of its box, that looks down.
RayEmitter slanting_emitter() {
  test::SceneMaker maker;
  maker.floor();
  maker.polygon({{0, 0, 3}, {0.3, 1.2, 3}, {1.5, 0, 3}}, test::white_light);
  const SoundScene scene = maker.sound();
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s)
    if (scene.materials[at(scene.surfaces[at(s)].material)].exitance.mean() > 0)
      return make_ray_emitter(scene, s);
  return {};
}

TEST(RayEmitter, RoughFactorsAreAsRightAsTheySay) {
  const RayEmitter emitter = slanting_emitter();
  test::Random random(4);
  int far = 0, near = 0;
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const double reach = std::exp(random(0, 5));
    const SurfacePoint point = {emitter.centroid + reach * random.direction(), random.direction()};
    const double rough = far_factor(point, emitter);
    const double right = unobstructed_factor(point.position, point.normal, emitter.target.rings);
    if (rough < 0) {
      ++near;
      continue;
    }
    ++far;
    EXPECT_GT(right, 0);
    worst = std::max(worst, std::abs(rough / right - 1));
  }
  EXPECT_LT(worst, far_error);
  EXPECT_GT(worst, 0.01);
  EXPECT_GT(far, 2000);
  EXPECT_GT(near, 2000);
}

TEST(RayEmitter, PointsFillItEvenly) {
  const RayEmitter emitter = slanting_emitter();
  SpreadPairs pairs(7);
  Vec3 sum = Vec3::Zero();
  constexpr int count = 4000;
  for (int k = 0; k < count; ++k) {
    const auto [s, t] = pairs.next();
    sum += emitter.point(s, t);
  }
  EXPECT_LT((sum / count - emitter.centroid).norm(), 1e-3);
  EXPECT_LE((emitter.point(0.3, 0.9) - emitter.centroid).norm(), emitter.radius);
}

}  // namespace
}  // namespace halfshade
