#include "solver/reflected/ray_exchange.h"

#include "meshing/repair/repair.h"
#include "solver/reflected/refinement.h"
#include "solver/reflected/unstable_elements.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

constexpr int strata = 7;
constexpr double all_rays = 2 * strata * strata;

/// A closed room with constant elements, and light that varies from place to place.
struct Room {
  explicit Room(double length)
      : reflecting(make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})))),
        light(first_light(
            make_sound(test::room({1, 1, 1}, {})), reflecting.roots,
            [](int, const Vec3& p) {
              return Rgb(Rgb::Constant(1 + std::sin(20 * p.x()) * std::cos(17 * p.y() + p.z())));
            },
            false)),
        mesh(make_reflected_mesh(reflecting.roots, length, 0, 100000)) {
    for (Rgb& rho : light.rho) rho = Rgb::Constant(0.5);
  }

  ReflectingScene reflecting;
  FirstLight light;
  ReflectedMesh mesh;
};

/// By how much light that goes to and fro falls with each bounce in the end, or grows.
double factor_of_bounces(const RayExchange& exchange, const ReflectedMesh& mesh,
                         const FirstLight& light) {
  const auto norm = [&](const ElementField& field) {
    double square = 0;
    for (int e = 0; e < mesh.count(); ++e) square += mesh.area(e) * field.of(e).square().sum();
    return std::sqrt(square);
  };
  ElementField field = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e)
    for (int k = 0; k < field.of(e).rows(); ++k) field.of(e).row(k) = std::cos(7 * e + 3 * k + 1);
  constexpr int bounces = 200, last = 50;
  double before = 0;
  for (int k = 0; k < bounces; ++k) {
    if (k == bounces - last) before = norm(field);
    field = exchange.apply(mesh, reflected_part(mesh, light, field));
  }
  return std::pow(norm(field) / before, 1. / last);
}

/// Two plates that partly cover each other, without light.
struct Plates {
  Plates(double rho, double gap)
      : sound(make_sound(scene(rho, gap))),
        reflecting(make_reflecting_scene(sound)),
        light(first_light(
            sound, reflecting.roots, [](int, const Vec3&) { return Rgb(Rgb::Zero()); }, false)),
        mesh(make_reflected_mesh(reflecting.roots, 0.3, 2, 100000)) {}

  static Scene scene(double rho, double gap);

  SoundScene sound;
  ReflectingScene reflecting;
  FirstLight light;
  ReflectedMesh mesh;
};

Scene Plates::scene(double rho, double gap) {
  Scene scene;
  const int white = test::add_material(scene, rho, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, white);
  test::add_polygon(scene, {{-.2, .9, gap}, {.8, 1.2, gap}, {1.2, .2, gap}, {.1, -.3, gap}}, white);
  return scene;
}

TEST(RayExchange, LightFallsWithEachBounceInAGap) {
  constexpr double rho = 0.8;
  auto [sound, reflecting, light, mesh] = Plates(rho, 1e-3);
  RayExchange exchange(reflecting, light, strata);
  ASSERT_TRUE(exchange.update(mesh, {}));
  ASSERT_GT(mesh.count(), 20);
  EXPECT_GT(factor_of_bounces(exchange, mesh, light), 1) << "it grows, for this test to tell";
  ASSERT_TRUE(exchange.lower_orders_in_gaps(mesh, {}));
  ASSERT_TRUE(exchange.update(mesh, {}));
  EXPECT_LE(factor_of_bounces(exchange, mesh, light), rho + 1e-3);
  // They stay constant, and their parts may be more once the gap is not narrow for them.
  std::vector<int> all;
  for (int e = 0; e < mesh.count(); ++e)
    if (mesh.stays_constant[at(mesh.triangle[at(e)])]) all.push_back(e);
  ASSERT_GT(all.size(), 10u);
  const int before = mesh.count();
  refine(mesh, all, std::vector<int>(all.size(), 1));
  EXPECT_EQ(mesh.count(), before + static_cast<int>(all.size()));
}

TEST(RayExchange, LeavesTheOrdersOfARoom) {
  Room room(0.3);
  room.mesh = make_reflected_mesh(room.reflecting.roots, 0.3, 2, 100000);
  const std::vector<int> before = room.mesh.order;
  RayExchange exchange(room.reflecting, room.light, strata);
  ASSERT_TRUE(exchange.lower_orders_in_gaps(room.mesh, {}));
  EXPECT_EQ(room.mesh.order, before);
}

TEST(UnstableElements, OfPlatesAreMadeConstantUntilLightFallsWithEachBounce) {
  auto [sound, reflecting, light, mesh] = Plates(0.9, 1e-3);
  RayExchange exchange(reflecting, light, strata);
  ASSERT_TRUE(exchange.update(mesh, {}));
  ASSERT_GT(factor_of_bounces(exchange, mesh, light), 1) << "it grows, for this test to tell";
  for (bool is_stable = false; !is_stable;) {
    const LightSystems systems = find_systems(reflecting, light, mesh, exchange);
    is_stable = !make_stable({mesh, light, exchange, systems}, mesh);
    ASSERT_TRUE(exchange.update(mesh, {}));
  }
  EXPECT_LT(factor_of_bounces(exchange, mesh, light), 0.99);
  EXPECT_GT(std::count(mesh.order.begin(), mesh.order.end(), 2), 0);
}

TEST(UnstableElements, AreNoneInARoom) {
  Room room(0.3);
  room.mesh = make_reflected_mesh(room.reflecting.roots, 0.3, 2, 100000);
  for (Rgb& rho : room.light.rho) rho = Rgb::Constant(0.95);
  RayExchange exchange(room.reflecting, room.light, strata);
  ASSERT_TRUE(exchange.update(room.mesh, {}));
  const LightSystems systems = find_systems(room.reflecting, room.light, room.mesh, exchange);
  EXPECT_TRUE(unstable_elements({room.mesh, room.light, exchange, systems}).empty());
}

TEST(RayExchange, TakesFewerRaysFromSmallElementsAmongVeryMany) {
  Room room(0.05);
  const int large = room.mesh.count();
  // The elements of one corner, four times.
  for (int k = 0; k < 4; ++k) {
    std::vector<int> near;
    for (int e = 0; e < room.mesh.count(); ++e)
      if (room.mesh.position(e, TrianglePlace::Constant(1. / 3)).norm() < 0.5) near.push_back(e);
    refine(room.mesh, near, std::vector<int>(near.size(), 1));
  }
  ASSERT_GT(room.mesh.count(), 20000);
  ASSERT_LT(large, 20000);
  RayExchange exchange(room.reflecting, room.light, strata);
  ASSERT_TRUE(exchange.update(room.mesh, {}));
  const std::vector<double> rays = exchange.rays_of_nodes(room.mesh);
  const FieldNoise noise = exchange.noise(room.mesh, zero_field(room.mesh));
  std::vector<double> scaled =
      noise_of_elements(noise, std::vector<double>(at(room.mesh.count()), 1));
  exchange.scale_to_all_rays(room.mesh, scaled);
  double area = 0;
  for (int e = 0; e < room.mesh.count(); ++e) area += room.mesh.area(e);
  const double mean = area / room.mesh.count();
  double noise_of_small = 0, area_of_small = 0, noise_of_large = 0, area_of_large = 0;
  for (int e = 0; e < room.mesh.count(); ++e) {
    const bool is_small = room.mesh.area(e) < 0.5 * mean;
    EXPECT_GE(rays[at(e)], 18);
    EXPECT_LE(rays[at(e)], all_rays);
    if (room.mesh.area(e) >= mean) {
      EXPECT_EQ(rays[at(e)], all_rays);
    }
    if (is_small) {
      EXPECT_LT(rays[at(e)], 0.8 * all_rays);
    }
    (is_small ? noise_of_small : noise_of_large) += scaled[at(e)];
    (is_small ? area_of_small : area_of_large) += room.mesh.area(e);
  }
  ASSERT_GT(area_of_small, 0.05 * area);
  const double ratio = noise_of_small / area_of_small / (noise_of_large / area_of_large);
  EXPECT_GT(ratio, 0.4);
  EXPECT_LT(ratio, 2.5);
  // In a closed room all rays arrive, however few.
  ElementField ones = zero_field(room.mesh);
  for (int e = 0; e < ones.count(); ++e) ones.of(e).row(0).setOnes();
  const ElementField arriving = exchange.apply(room.mesh, ones);
  for (int e = 0; e < ones.count(); ++e) EXPECT_NEAR(arriving.of(e)(0, 0), 1, 1e-6);
}

TEST(RayExchange, TakesAllRaysFromEachOfFewElements) {
  Room room(0.3);
  refine(room.mesh, std::vector<int>{0, 1, 2}, {2, 2, 2});
  RayExchange exchange(room.reflecting, room.light, strata);
  ASSERT_TRUE(exchange.update(room.mesh, {}));
  for (const double rays : exchange.rays_of_nodes(room.mesh)) EXPECT_EQ(rays, all_rays);
}

}  // namespace
}  // namespace halfshade
