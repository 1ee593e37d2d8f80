#include "solver/reflected/refinement.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// A cube whose elements are all off alike, by so much of the goal in all.
struct CubeOff {
  explicit CubeOff(double times_the_goal)
      : scene(make_sound(test::room({1, 1, 1}, {}))),
        mesh(make_reflected_mesh(PatchMesh(scene, {}).elements(), 0.2, 2, 100000)),
        field(zero_field(mesh)) {
    for (int e = 0; e < mesh.count(); ++e)
      field.of(e).bottomRows(1) = std::sqrt(times_the_goal / mesh.area(e));
    estimate.square_error.assign(at(mesh.count()), 0);
    estimate.chance = estimate.square_error;
    estimate.sum = times_the_goal;
  }

  RefinementPlan plan() const {
    const std::vector<double> none(at(mesh.count())), weight(at(mesh.count()), 1);
    BalanceEstimate balance;
    balance.of_element = none;
    return plan_refinement({mesh, field, none, weight, estimate, balance}, 1);
  }

  SoundScene scene;
  ReflectedMesh mesh;
  ElementField field;
  ReflectionEstimate estimate;
};

RefinementPlan plan_where_all_are_off(double times_the_goal) {
  return CubeOff(times_the_goal).plan();
}

TEST(Refinement, LeavesElementsAloneThatAreFineEnough) {
  EXPECT_TRUE(plan_where_all_are_off(0.5).elements.empty());
}

TEST(Refinement, BisectsElementsMoreOftenTheFartherTheyAreOff) {
  // All together may be off by .3 of the goal.
  const std::vector<std::pair<double, int>> expected = {{1, 1},  {4.7, 1},  {4.9, 2},  {76, 2},
                                                        {78, 3}, {1220, 3}, {1240, 4}, {1e9, 4}};
  for (const auto& [off, times] : expected) {
    const RefinementPlan plan = plan_where_all_are_off(off);
    ASSERT_FALSE(plan.elements.empty());
    ASSERT_EQ(plan.times.size(), plan.elements.size());
    EXPECT_EQ(std::ranges::min(plan.times), times) << off;
    EXPECT_EQ(std::ranges::max(plan.times), times) << off;
  }
}

TEST(Refinement, WhatPointsSeldomFindStandsForElementsLikeIt) {
  CubeOff cube(0.7);
  cube.estimate.square_error[0] = 3 * 0.7;
  cube.estimate.square_error[1] = -2 * 0.7;
  const auto share_of_refined = [&](double chance) {
    cube.estimate.chance[0] = cube.estimate.chance[1] = chance;
    return static_cast<double>(cube.plan().elements.size()) / cube.mesh.count();
  };
  // Refining all but takes half of the error away, which .3 of the goal need; if the first element
  // had three times as much to itself, half of the others would do.
  EXPECT_GT(share_of_refined(0.05), 0.9);
  EXPECT_NEAR(share_of_refined(1), 0.52, 0.02);
}

TEST(Refinement, WhatFewPointsSayOfAllRefinesNoMoreThanTheRest) {
  // Fifteen of sixteen parts were found at one place.
  CubeOff cube(8);
  cube.estimate.deviation = 7.5;
  EXPECT_EQ(std::ranges::max(cube.plan().times), 1);
  cube.estimate.deviation = 0.8;
  EXPECT_EQ(std::ranges::min(cube.plan().times), 2);
}

TEST(Refinement, EachBisectionDoublesTheParts) {
  const SoundScene scene = make_sound(test::room({1, 1, 1}, {}));
  ReflectedMesh mesh = make_reflected_mesh(PatchMesh(scene, {}).elements(), 0.2, 2, 100000);
  const int before = mesh.count();
  refine(mesh, std::vector<int>{0, 1, 2}, {1, 3, 4});
  EXPECT_EQ(mesh.count(), before + 1 + 7 + 15);
}

}  // namespace
}  // namespace halfshade
