#include "meshing/backprojection/edge_sum.h"
#include "meshing/repair/repair.h"
#include "solver/direct/emitter_target.h"
#include "solver/direct/ray_light.h"
#include "tests/support/lamp_hall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

// Light of far more lamps than a place needs to look at each of.
namespace halfshade {
namespace {

constexpr int lamps_each_way = 8, lamp_count = lamps_each_way * lamps_each_way;

struct LitHall {
  SoundScene scene;
  DirectLightIndex exact;
  VisibilityIndex visibility;

  explicit LitHall(const Scene& made)
      : scene(make_sound(made)), exact(scene), visibility(occluders(scene)) {}

  RayLight rays(double deviation, double most_rays = 1e6) const {
    return {scene, exact, visibility, {deviation, most_rays}};
  }

  /// On the triangles of the surfaces that send no light, off their borders.
  std::vector<FieldPoint> places(int count) const {
    test::Random random(3);
    std::vector<FieldPoint> result;
    while (static_cast<int>(result.size()) < count) {
      const int s = random.integer(0, static_cast<int>(scene.surfaces.size()) - 1);
      const Surface& surface = scene.surfaces[at(random(0, 1) < 0.5 ? 0 : s)];
      if (scene.materials[at(surface.material)].exitance.mean() > 0) continue;
      const Ring& ring = surface.rings[0];
      double u = random(0, 1), v = random(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec2 p = ring[0] + u * (ring[1] - ring[0]) + v * (ring[2] - ring[0]);
      result.push_back({{surface.frame.to_space(p), surface.frame.normal},
                        static_cast<int>(&surface - scene.surfaces.data())});
    }
    return result;
  }

  double unobstructed(const SurfacePoint& point) const {
    double sum = 0;
    for (const int id : exact.emitters()) {
      const EmitterTarget target = make_emitter_target(scene, scene.surfaces[at(id)]);
      sum += target.strength * unobstructed_factor(point.position, point.normal, target.rings);
    }
    return sum;
  }
};

const LitHall& lit_hall() {
  static const LitHall hall(test::lamp_hall(lamps_each_way));
  return hall;
}

/// Places and exact light there.
struct Reference {
  std::vector<FieldPoint> places = lit_hall().places(400);
  std::vector<double> light;
  double mean = 0;

  Reference() {
    std::vector<SurfacePoint> points;
    for (const FieldPoint& place : places) points.push_back(place.point);
    for (const DirectLight& here : lit_hall().exact.irradiance(points))
      mean += light.emplace_back(here.irradiance.mean()) / static_cast<double>(points.size());
  }
};

const Reference& reference() {
  static const Reference found;
  return found;
}

TEST(ManyLamps, HaveTheMeanAndTheDeviationAskedForWithFewRays) {
  const auto& places = reference().places;
  double rays_before = 0;
  for (const double share : {0.2, 0.05}) {
    const double deviation = share * reference().mean;
    const RayLight light = lit_hall().rays(deviation);
    const auto found = light.irradiance(places).at;
    double off = 0, square = 0, product = 0, half_square = 0, rays = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double a = found[k].a.mean() - reference().light[k];
      const double b = found[k].b.mean() - reference().light[k];
      off += (a + b) / 2;
      square += (a + b) * (a + b) / 4;
      half_square += (a * a + b * b) / 2;
      product += a * b;
      rays += light.cost(places[k].point);
    }
    const auto count = static_cast<double>(places.size());
    EXPECT_GT(std::sqrt(square / count), 0.2 * deviation);
    EXPECT_LT(std::sqrt(square / count), deviation);
    EXPECT_LT(std::abs(off), 4 * std::sqrt(square));
    // Two estimates have nothing to do with each other.
    EXPECT_LT(std::abs(product), 0.3 * half_square);
    // One ray to each lamp for each of two estimates would be more.
    if (share > 0.1) {
      EXPECT_LT(rays / count, 0.5 * 2 * lamp_count);
    }
    EXPECT_GT(rays, rays_before);
    rays_before = rays;
  }
}

TEST(ManyLamps, AreTheSameInAnyUnitAndBatch) {
  const auto places = lit_hall().places(300);
  const double deviation = 0.1 * reference().mean;
  constexpr double odd = 3.7e5;
  Scene scaled = test::lamp_hall(lamps_each_way);
  for (Vec3& p : scaled.vertices) p *= odd;
  const LitHall in_odd(scaled);
  const RayLight light = lit_hall().rays(deviation), other = in_odd.rays(deviation);
  const auto found = light.irradiance(places).at;
  int by_chance = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const NoisyValue alone = light.irradiance(std::span(&places[k], 1)).at[0];
    EXPECT_TRUE((alone.a == found[k].a).all() && (alone.b == found[k].b).all());
    FieldPoint place = places[k];
    place.point.position *= odd;
    const NoisyValue there = other.irradiance(std::span(&place, 1)).at[0];
    EXPECT_TRUE(there.a.isApprox(found[k].a, 1e-9) || found[k].a.isZero(1e-12));
    by_chance += (found[k].a != found[k].b).any();
  }
  EXPECT_GT(by_chance, 100);
}

TEST(ManyLamps, AreBoundedByWhatTheyGiveUnobstructed) {
  const auto places = lit_hall().places(500);
  const double deviation = 0.1 * reference().mean;
  const RayLight light = lit_hall().rays(deviation);
  for (const FieldPoint& place : places) {
    const double found = light.unobstructed(place.point);
    const double right = lit_hall().unobstructed(place.point);
    EXPECT_GE(found, right * (1 - 1e-12));
    EXPECT_LE(found, right * 1.2 + 0.1 * deviation);  // groups
  }
}

TEST(ManyLamps, AreNearlyExactWithoutShadows) {
  test::SceneMaker maker;
  maker.up({0, 0}, {20, 20}, 0);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      maker.down({2. * i + 0.6, 2. * j + 0.6}, {2. * i + 1, 2. * j + 1}, 3, test::white_light);
  const LitHall open(maker.scene);
  const auto places = open.places(300);
  const double deviation = 0.1 * open.unobstructed({{10, 10, 0}, Vec3::UnitZ()});
  const RayLight light = open.rays(deviation);
  const auto found = light.irradiance(places).at;
  double square = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double exact = open.exact.irradiance(places[k].point).irradiance.mean();
    EXPECT_NEAR(found[k].a.mean(), exact, 0.7 * deviation);
    EXPECT_NEAR(found[k].b.mean(), exact, 0.7 * deviation);
    square += std::pow(found[k].mean().mean() - exact, 2);
  }
  // What is left comes of colours, rough form factors and groups.
  EXPECT_LT(std::sqrt(square / static_cast<double>(places.size())), 0.15 * deviation);
}

}  // namespace
}  // namespace halfshade
