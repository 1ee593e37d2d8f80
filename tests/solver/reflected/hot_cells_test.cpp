#include "solver/reflected/hot_cells.h"

#include "meshing/repair/repair.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

constexpr double bright = 50, cells = 20000;

/// A spot of the ceiling, and a glow of everything.
Rgb in_room(int /*root*/, const Vec3& p) {
  const bool in_spot = p.z() > 0.999 && std::abs(p.x() - 0.7) < 0.1 && std::abs(p.y() - 0.6) < 0.1;
  return Rgb::Constant(in_spot ? bright : 1);
}

/// Of many runs, each with rays of its own.
struct Runs {
  double mean = 0, square = 0;

  double deviation() const { return std::sqrt(square - mean * mean); }
};

Runs gather(const ReflectingScene& scene, const HotCells& hot, const RayOrigin& from, int runs,
            Looks looks = Looks::exact, const LeavingCells::Leaving& leaving = in_room) {
  constexpr int strata = 7;
  Runs result;
  std::vector<RayHemisphere> hemispheres;
  for (int k = 0; k < runs; ++k)
    hemispheres.push_back({from, strata, static_cast<std::uint64_t>(k)});
  const ChannelArray light =
      hot.irradiance(scene, leaving, looks, hemispheres, trace_hemispheres(scene, hemispheres));
  for (int k = 0; k < runs; ++k) {
    result.mean += light.row(k).mean() / runs;
    result.square += std::pow(light.row(k).mean(), 2) / runs;
  }
  return result;
}

/// Irradiance at (.3, .4, 0) of the cube, in closed form.
double expected_in_room() {
  const std::vector<Vec3> spot = {{0.6, 0.5, 1}, {0.6, 0.7, 1}, {0.8, 0.7, 1}, {0.8, 0.5, 1}};
  return 1 + (bright - 1) * point_to_polygon({0.3, 0.4, 0}, Vec3::UnitZ(), spot);
}

TEST(HotCells, HaveTheMeanOfTheClosedFormAndLessNoise) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const HotCells hot(scene, {}, {scene, {}, cells, in_room});
  EXPECT_GT(hot.count(49), 0);
  EXPECT_EQ(HotCells().count(49), 0);
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ(), scene.cells.before(0), true, 0};
  const double expected = expected_in_room();
  constexpr int runs = 4000;
  const Runs aimed = gather(scene, hot, from, runs), plain = gather(scene, {}, from, runs);
  EXPECT_NEAR(aimed.mean, expected, 4 * aimed.deviation() / std::sqrt(runs));
  EXPECT_NEAR(plain.mean, expected, 4 * plain.deviation() / std::sqrt(runs));
  EXPECT_LT(aimed.deviation(), 0.7 * plain.deviation());
}

TEST(HotCells, QuickLooksHaveTheSameMean) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ(), scene.cells.before(0), true, 0};
  constexpr int runs = 4000;
  // The second has cells of .2 on walls, and most of what it sees is near.
  for (const double wanted : {cells, 300.}) {
    const HotCells hot(scene, {}, {scene, {}, wanted, in_room});
    const Runs exact = gather(scene, hot, from, runs);
    const Runs quick = gather(scene, hot, from, runs, Looks::quick);
    EXPECT_NEAR(quick.mean, expected_in_room(), 0.005 * expected_in_room());
    EXPECT_LT(quick.deviation(), 1.1 * exact.deviation());
  }
}

/// The noise above one end of a corridor whose ceiling has spots one apart, so many of them.
double noise_in_corridor(int spots) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({20, 1, 1}, {})));
  const LeavingCells::Leaving leaving = [spots](int /*root*/, const Vec3& p) {
    const bool in_spot = p.z() > 0.999 && p.x() < spots && std::abs(p.y() - 0.6) < 0.1 &&
                         std::abs(p.x() - std::floor(p.x()) - 0.7) < 0.1;
    return Rgb(Rgb::Constant(in_spot ? bright : 1));
  };
  const HotCells hot(scene, {}, {scene, {}, cells, leaving});
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ(), scene.cells.before(0), true, 0};
  return gather(scene, hot, from, 4000, Looks::exact, leaving).deviation();
}

TEST(HotCells, ThoseFarAwayTakeFewRaysFromThoseNear) {
  EXPECT_LT(noise_in_corridor(20), 1.05 * noise_in_corridor(5));
}

TEST(HotCells, AreNoneWhereLightIsEven) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const auto ones = [](int, const Vec3&) { return Rgb(Rgb::Ones()); };
  const HotCells even(scene, {}, {scene, {}, cells, ones});
  EXPECT_EQ(even.count(10000), 0);
}

}  // namespace
}  // namespace halfshade
