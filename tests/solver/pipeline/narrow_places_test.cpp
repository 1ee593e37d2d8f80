#include "solver/pipeline/narrow_places.h"

#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

/// A floor of 4 × 4, a lamp that is next to a point at (0, 0, 2), and three bars half way up.
struct Bars {
  static constexpr std::array<double, 3> middle = {-0.6, 0, 0.5}, width = {1e-4, 0.01, 0.2};
  SoundScene scene = test::empty_sound_scene(6);

  Bars() {
    test::add_surface(scene, {{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, 0);
    constexpr double r = 1e-7;
    test::add_surface(scene, {{{-r, -r, 2}, {-r, r, 2}, {r, r, 2}, {r, -r, 2}}}, 0);
    for (std::size_t k = 0; k < middle.size(); ++k) {
      const double low = middle[k] - width[k] / 2, high = middle[k] + width[k] / 2;
      test::add_surface(scene, {{{low, -1, 1}, {low, 1, 1}, {high, 1, 1}, {high, -1, 1}}}, 0);
    }
  }

  std::vector<WatchedPlace> places(const Progress& progress = {}) const {
    const std::array<int, 1> lamp = {1};
    const std::array<int, 3> blocking = {2, 3, 4};
    return narrow_places(scene, lamp, blocking, progress);
  }
};

TEST(NarrowPlaces, AreInTheMiddleOfShadowsHoweverWide) {
  const std::vector<WatchedPlace> places = Bars().places();
  for (std::size_t k = 0; k < Bars::middle.size(); ++k) {
    // As far from the lamp as the floor is, twice as far as the bars.
    const double x = 2 * Bars::middle[k], width = 2 * Bars::width[k];
    EXPECT_TRUE(std::ranges::any_of(places, [&](const WatchedPlace& place) {
      return place.place.surface == 0 &&
             std::abs(place.place.point.position.x() - x) < 0.01 * width;
    })) << width;
  }
}

TEST(NarrowPlaces, AreNotLookedForOnceStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(Bars().places({stop.get_token(), {}}).empty());
}

}  // namespace
}  // namespace halfshade
