#include "solver/factors/pair_on_lattices.h"

#include "solver/factors/factor_scene.h"
#include "solver/factors/points_across.h"
#include "tests/support/random.h"
#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

const Quad unit_square = {Vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// What jumps, as where things stand on a floor, is found as exactly as it says. (As if nothing
/// jumped, 29 of 263 were off by up to 2.6 times as much.)
TEST(PairOnLattices, TellsWhatJumpsAreOffBy) {
  const SoundScene sound = test::SceneMaker().floor().sound();
  const SightScene sight = make_sight_scene(sound);
  test::Random random(17);
  int told = 0;
  double worst = 0;
  for (int k = 0; k < 400; ++k) {
    // Discs of one radius that lie apart hide all.
    std::vector<Vec2> discs;
    const double radius = random(.06, .18);
    for (int d = 0; d < 12; ++d) {
      const Vec2 centre(random(radius, 1 - radius), random(radius, 1 - radius));
      if (std::all_of(discs.begin(), discs.end(),
                      [&](const Vec2& p) { return (p - centre).norm() > 2 * radius; }))
        discs.push_back(centre);
    }
    SharedShadows shadows(sight);
    LatticeTarget target;
    target.points_across = 16;
    target.weight_of_jumps = weight_where_alone;
    target.unhidden = [](const SightTolerance&) {
      MutualSight all;
      all.value = 1;
      return all;
    };
    target.hidden_factor = [&](HiddenFactor& factor) {
      const Vec2 at = shadows.outlines().point().head<2>();
      factor = {1, 0, false, 0};
      for (const Vec2& p : discs)
        if ((p - at).norm() < radius) factor = {1, 1, true, 0};
      return true;
    };
    SightTolerance tolerance;
    tolerance.absolute = std::pow(10, random(-3, -1.3));
    PairOnLattices pair(target, 1, {tolerance, false, few_lattice_places});
    look_at({&pair}, std::vector<Quad>{unit_square}, shadows, {});
    if (!pair.tells() || !pair.sight().is_reached) continue;
    const double area = std::numbers::pi * radius * radius * static_cast<double>(discs.size());
    worst = std::max(worst, std::abs(pair.sight().value - (1 - area)) / pair.sight().error);
    ++told;
  }
  EXPECT_GT(told, 100);
  EXPECT_LT(worst, 1);
}

TEST(PointsAcross, AsManyAsThingsCoverOrLieAlongIt) {
  ConvexBody body;
  body.width = .1;
  body.vertices = {{0, 0, 5}};
  const auto points = [&](const Quad& quad) {
    const PlaneFrame floor;
    const std::vector<Quad> quads = {quad};
    PointsAcross across(floor, quads, {Vec3(0, 0, 5), 1000});
    across.add(body);
    return across.points();
  };
  EXPECT_NEAR(points(unit_square), 100, 1e-9);
  EXPECT_NEAR(points({Vec3(0, 0, 0), {10, 0, 0}, {10, .01, 0}, {0, .01, 0}}), 100, 1e-3);
  EXPECT_NEAR(points({Vec3(0, 0, 0), {0, 0, 0}, {10, 0, 0}, {0, 1, 0}}), 1000, 50);
  body.vertices = {{0, 0, .05}};
  EXPECT_NEAR(points(unit_square), 400, 1e-9) << "some lie under it";
}

}  // namespace
}  // namespace halfshade
