#include "solver/direct/ray_light.h"

#include "meshing/repair/repair.h"
#include "tests/support/expect_error.h"
#include "tests/support/room_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace halfshade {
namespace {

/// A sound scene, and both ways to find direct light in it.
struct Lit {
  SoundScene scene;
  DirectLightIndex exact;
  VisibilityIndex visibility;
  RayLight rays;

  Lit(const Scene& made, double deviation, double most_rays = 1e6)
      : scene(make_sound(made)),
        exact(scene),
        visibility(occluders(scene)),
        rays(scene, exact, visibility, {deviation, most_rays}) {}
};

/// On surfaces, off their borders.
std::vector<FieldPoint> random_places(const SoundScene& scene, int count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<FieldPoint> places;
  while (static_cast<int>(places.size()) < count) {
    const int s = random.integer(0, static_cast<int>(scene.surfaces.size()) - 1);
    const Surface& surface = scene.surfaces[at(s)];
    const Ring& ring = surface.rings[0];
    const Vec2 &a = ring[0], &b = ring[1], &c = ring[2];
    double u = random(0, 1), v = random(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec2 p = a + u * (b - a) + v * (c - a);
    places.push_back({{surface.frame.to_space(p), surface.frame.normal}, s});
  }
  return places;
}

std::vector<SurfacePoint> points_of(const std::vector<FieldPoint>& places) {
  std::vector<SurfacePoint> points;
  for (const FieldPoint& place : places) points.push_back(place.point);
  return points;
}

constexpr double light_of_room = 0.02;  // W/m², about the mean of what rooms here get

TEST(RayLight, HasTheMeanAndTheDeviationAskedFor) {
  for (const char kind : {'A', 'B'}) {
    const double deviation = 0.1 * light_of_room;
    const Lit lit(test::family(kind, 300), deviation);
    const auto places = random_places(lit.scene, 30000, 5);
    const auto exact = lit.exact.irradiance(points_of(places));
    const auto found = lit.rays.irradiance(places).at;
    double off = 0, square = 0, product = 0, half_square = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double a = found[k].a.mean() - exact[k].irradiance.mean();
      const double b = found[k].b.mean() - exact[k].irradiance.mean();
      off += (a + b) / 2;
      square += (a + b) * (a + b) / 4;
      half_square += (a * a + b * b) / 2;
      product += a * b;
    }
    const auto count = static_cast<double>(places.size());
    EXPECT_GT(square, 0);
    EXPECT_LT(std::sqrt(square / count), deviation) << kind;
    EXPECT_LT(std::abs(off), 4 * std::sqrt(square)) << kind;
    // Two estimates have nothing to do with each other.
    EXPECT_LT(std::abs(product), 0.15 * half_square) << kind;
  }
}

TEST(RayLight, IsExactWithoutShadowsAndInTheDark) {
  const Lit lit(test::cluttered_room(300), 0.1 * light_of_room);
  const auto places = random_places(lit.scene, 3000, 6);
  const auto found = lit.rays.irradiance(places).at;
  int lit_places = 0, dark = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const DirectLight exact = lit.exact.irradiance(places[k].point);
    if (exact.region == Region::lit) {
      ++lit_places;
      EXPECT_NEAR(found[k].a.mean(), exact.irradiance.mean(), 1e-12 * exact.irradiance.mean());
      EXPECT_NEAR(found[k].b.mean(), exact.irradiance.mean(), 1e-12 * exact.irradiance.mean());
    } else if (exact.irradiance.isZero(0)) {
      ++dark;
      EXPECT_TRUE(found[k].a.isZero(0) && found[k].b.isZero(0));
    }
    EXPECT_GE(lit.rays.unobstructed(places[k].point), exact.irradiance.mean() * (1 - 1e-12));
  }
  EXPECT_GT(lit_places, 100);
  EXPECT_GT(dark, 100);
}

TEST(RayLight, LooksExactlyWhereThatTakesLess) {
  const Lit lit(test::furnished_room(300), 1e-6 * light_of_room, 50);
  const auto places = random_places(lit.scene, 300, 7);
  const auto found = lit.rays.irradiance(places).at;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Rgb exact = lit.exact.irradiance(places[k].point).irradiance;
    EXPECT_TRUE(found[k].a.isApprox(exact, 1e-12) || exact.isZero(1e-300));
    EXPECT_LE(lit.rays.cost(places[k].point), 50);
  }
}

TEST(RayLight, DoesNotDependOnUnitOrBatch) {
  const Scene room = test::furnished_room(300);
  const auto in_unit = [&](double unit) {
    Scene scaled = room;
    for (Vec3& p : scaled.vertices) p *= unit;
    return scaled;
  };
  constexpr double odd = 3.7e5, power_of_two = 0x1p-20;
  const Lit lit(room, 0.1 * light_of_room);
  const Lit in_odd(in_unit(odd), 0.1 * light_of_room);
  const Lit in_power(in_unit(power_of_two), 0.1 * light_of_room);
  const auto places = random_places(lit.scene, 4000, 8);
  const auto found = lit.rays.irradiance(places).at;
  int by_chance = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto alone = [&](const Lit& other, double unit) {
      FieldPoint place = places[k];
      place.point.position *= unit;
      return other.rays.irradiance(std::span(&place, 1)).at[0];
    };
    EXPECT_TRUE((alone(lit, 1).a == found[k].a).all() && (alone(lit, 1).b == found[k].b).all());
    EXPECT_TRUE((alone(in_power, power_of_two).a == found[k].a).all());
    const Rgb scaled = alone(in_odd, odd).a;
    EXPECT_TRUE(scaled.isApprox(found[k].a, 1e-9) || found[k].a.isZero(1e-12));
    by_chance += (found[k].a != found[k].b).any();
  }
  EXPECT_GT(by_chance, 20);
}

TEST(RayLight, SaysWhatTrianglesSee) {
  const Lit lit(test::cluttered_room(300), 0.1 * light_of_room);
  const auto places = random_places(lit.scene, 1000, 9);
  int told = 0;
  for (const FieldPoint& place : places) {
    const PlaneFrame& frame = lit.scene.surfaces[at(place.surface)].frame;
    const Vec3 p = place.point.position;
    const std::array<Vec3, 3> triangle = {p, p + 1e-7 * frame.e1, p + 1e-7 * frame.e2};
    const Region exact = lit.exact.region(place.point);
    if (exact == Region::away) continue;
    const Region found = lit.rays.region(triangle, frame.normal, place.surface);
    // Rays may miss a little of the light, or what hides a little of it.
    // None of them may be above the horizon.
    if (exact == Region::penumbra || found == Region::away) continue;
    EXPECT_EQ(found, exact);
    ++told;
  }
  EXPECT_GT(told, 300);
}

TEST(RayLight, RefusesWhatIsOutOfRange) {
  const Lit lit(test::furnished_room(100), 1);
  for (const RayLightOptions& options :
       {RayLightOptions{0, 10}, RayLightOptions{1, 0}, RayLightOptions{INFINITY, 10}})
    test::expect_error([&] { RayLight(lit.scene, lit.exact, lit.visibility, options); },
                       ErrorCode::contract, {"out of range"});
}

}  // namespace
}  // namespace halfshade
