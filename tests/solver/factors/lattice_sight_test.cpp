#include "solver/factors/lattice_sight.h"

#include "solver/factors/mutual_sight.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// A bar under eight others across it, and a ceiling that it sees past them.
SightScene crossed_bars() {
  test::SceneMaker maker;
  maker.up({-.05, -.8}, {.05, .8}, 1.5);
  maker.down({-5, -5}, {5, 5}, 4);
  for (int k = 0; k < 8; ++k) {
    const double y = -.75 + .2 * k;
    maker.down({-.8, y}, {.8, y + .1}, 1.6);
  }
  return make_sight_scene(maker.sound());
}

MutualSight seen_by_lattices(const SightScene& sight, std::size_t most_places, bool to_the_end) {
  const std::array<LatticePair, 1> pair = {LatticePair{1, {1e-6, 0, 1000000}, {}, to_the_end}};
  const auto seen = lattice_sight(sight, 0, pair, most_places);
  EXPECT_TRUE(seen.front());
  return seen.front().value_or(MutualSight{});
}

/// Kinks are everywhere: a few points tell that no lattice is expected to be enough, and many are
/// far more exact, if they are asked for.
TEST(LatticeSight, GoesOnToTheEndIfAskedTo) {
  const SightScene sight = crossed_bars();
  const MutualSight few = seen_by_lattices(sight, few_lattice_places, false);
  EXPECT_FALSE(few.is_reached);
  const MutualSight given_up = seen_by_lattices(sight, most_lattice_places, false);
  EXPECT_FALSE(given_up.is_reached);
  EXPECT_LT(given_up.points, 10000u);
  const MutualSight many = seen_by_lattices(sight, most_lattice_places, true);
  EXPECT_GT(many.points, 30000u);
  EXPECT_LT(many.error, 5e-6 * many.value);
  const MutualSight cells = partial_sight(sight, 0, 1, {1e-6, 0, 200000});
  EXPECT_LT(std::abs(cells.value - many.value), cells.error + many.error);
  EXPECT_LT(std::abs(few.value - many.value), few.error + many.error);
}

/// Corners apart.
TEST(LatticeSight, TakesNoMorePointsThanAllowed) {
  const SightScene sight = crossed_bars();
  for (const int most : {1000, 5000, 20000}) {
    const std::array<LatticePair, 1> pair = {LatticePair{1, {1e-9, 0, most}, {}, true}};
    const auto seen = lattice_sight(sight, 0, pair, most_lattice_places);
    ASSERT_TRUE(seen.front());
    constexpr std::size_t corners = 4;
    EXPECT_LE(seen.front()->points, static_cast<std::size_t>(most) + corners);
  }
}

}  // namespace
}  // namespace halfshade
