#include "solver/pipeline/direct_rays.h"

#include "solver/pipeline/solve.h"
#include "solver/pipeline/spread_places.h"
#include "tests/support/direct_error.h"
#include "tests/support/random.h"
#include "tests/support/room_families.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <vector>

namespace halfshade {
namespace {

/// A furnished room below many small lights.
Scene room_with_lights() {
  test::SceneMaker maker;
  maker.scene = test::furnished_room(1500);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const Vec2 low(0.41 + 1.22 * i, 0.53 + 1.21 * j);
      maker.down(low, low + Vec2(0.4, 0.1), 2.9, test::bright_light);
    }
  return maker.scene;
}

TEST(DirectRays, AreForManyThingsAndLooseTolerances) {
  const PreparedScene crowded(room_with_lights());
  EXPECT_GT(direct_rays(crowded, test::directly(0.05)).deviation, 0);
  EXPECT_EQ(direct_rays(crowded, test::directly(0.002)).deviation, 0);
  SolveOptions exact = test::directly(0.05);
  exact.visibility = ReflectedVisibility::exact;
  EXPECT_EQ(direct_rays(crowded, exact).deviation, 0);
  SolveOptions forced = test::directly(0.05);
  forced.force.exact_direct_light = true;
  EXPECT_EQ(direct_rays(crowded, forced).deviation, 0);
  EXPECT_EQ(direct_rays(PreparedScene(test::furnished_room(50)), test::directly(0.05)).deviation,
            0);
}

/// A net of crossing bars as thick as their gaps are wide, which hangs in a large room: a look from
/// the floor below takes long past all of them, and one from a bar does not.
Scene net_in_a_room() {
  test::SceneMaker maker;
  maker.down({-1, -1}, {1, 1}, 4, test::white_light);
  maker.up({-3, -3}, {3, 3}, 0);
  constexpr int bars = 40;
  constexpr double pitch = 0.02, thick = pitch / 2, length = bars * pitch;
  for (int layer = 0; layer < 6; ++layer)
    for (int k = 0; k < bars; ++k) {
      const double from = pitch * k, to = from + thick, z = 1 + pitch * layer;
      if (layer % 2 == 0)
        maker.up({from, 0}, {to, length}, z);
      else
        maker.up({0, from}, {length, to}, z);
    }
  return maker.scene;
}

// On the bars rays take more than twice as long as exact looks: too little to matter.
TEST(DirectRays, AreForNetsInLargeRooms) {
  EXPECT_GT(direct_rays(PreparedScene(net_in_a_room()), test::directly(0.05)).deviation, 0);
}

/// Triangles through each other, of which the first shines.
Scene soup(std::uint64_t seed) {
  test::Random random(seed);
  Scene scene;
  const int grey = test::add_material(scene, 0.5, 0), lamp = test::add_material(scene, 0.2, 10);
  for (int k = 0; k < 150; ++k) {
    const Vec3 middle = random.point(0, 1);
    test::add_polygon(scene,
                      {middle + random.point(-0.4, 0.4), middle + random.point(-0.4, 0.4),
                       middle + random.point(-0.4, 0.4)},
                      k == 0 ? lamp : grey);
  }
  return scene;
}

/// W/m², in the mean over what is lit.
double mean_of_lit(const PreparedScene& prepared) {
  std::vector<int> all(prepared.scene().surfaces.size());
  std::iota(all.begin(), all.end(), 0);
  double sum = 0, lit = 0;
  for (const DirectLight& light :
       prepared.direct_light().irradiance(spread_places(prepared.scene(), all, 20000).points)) {
    sum += light.irradiance.mean();
    lit += light.irradiance.mean() > 0;
  }
  return sum / lit;
}

// One or two of the hundred places that are tried get light: much less than the mean in one of the
// scenes, and twice as much in the other.
TEST(DirectRays, AreAsNoisyAsSuitsTheLightWhereHardlyAnyPlaceGetsAny) {
  for (const std::uint64_t seed : {17, 24}) {
    const PreparedScene prepared(soup(seed));
    const double right = 1.5 * 0.03 * mean_of_lit(prepared);
    const double deviation = direct_rays(prepared, test::directly(0.03)).deviation;
    EXPECT_GT(deviation, 0.5 * right) << seed;
    EXPECT_LT(deviation, 1.5 * right) << seed;
  }
}

TEST(DirectRays, AreNotNeededWhereNoPlaceLiesBeforeALamp) {
  EXPECT_EQ(direct_rays(PreparedScene(soup(32)), test::directly(0.03)).deviation, 0);
}

TEST(DirectRays, SolveToTheToleranceAsked) {
  const PreparedScene prepared(room_with_lights());
  const SolveResult result = solve(prepared, test::directly(0.05));
  ASSERT_TRUE(result.refinement.is_noisy);
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  EXPECT_LE(result.relative_error, 0.05);
  const double off = test::direct_error(prepared, result);
  EXPECT_LE(off, 0.05);
  EXPECT_LE(off, 1.1 * result.relative_error);
  EXPECT_GE(3 * off, result.relative_error);
}

TEST(DirectRays, GiveTheSameOnAnyNumberOfThreads) {
  const PreparedScene prepared(room_with_lights());
  const auto solve_on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return solve(prepared, test::directly(0.1)).irradiance.coefficients;
  };
  const ChannelArray one = solve_on(1), two = solve_on(2);
  ASSERT_EQ(one.rows(), two.rows());
  EXPECT_TRUE((one == two).all());
}

}  // namespace
}  // namespace halfshade
