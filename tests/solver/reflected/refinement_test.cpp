#include "solver/reflected/refinement.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// The plan for a cube whose elements are all off alike, by so much of the goal in all.
RefinementPlan plan_where_all_are_off(double times_the_goal) {
  const SoundScene scene = make_sound(test::room({1, 1, 1}, {}));
  const ReflectedMesh mesh = make_reflected_mesh(PatchMesh(scene, {}).elements(), 0.2, 2, 100000);
  ElementField field = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e)
    field.of(e).bottomRows(1) = std::sqrt(times_the_goal / mesh.area(e));
  const std::vector<double> none(at(mesh.count())), weight(at(mesh.count()), 1);
  ReflectionEstimate estimate;
  estimate.square_error = none;
  estimate.sum = times_the_goal;
  BalanceEstimate balance;
  balance.of_element = none;
  return plan_refinement({mesh, field, none, weight, estimate, balance}, 1);
}

TEST(Refinement, LeavesElementsAloneThatAreFineEnough) {
  EXPECT_TRUE(plan_where_all_are_off(0.5).elements.empty());
}

TEST(Refinement, BisectsElementsMoreOftenTheFartherTheyAreOff) {
  // An element may be off by .3 of the goal, and three quarters of what it is off are its own.
  const std::vector<std::pair<double, int>> expected = {{1, 1},   {6, 1},    {7, 2},    {100, 2},
                                                        {105, 3}, {1600, 3}, {1700, 4}, {1e9, 4}};
  for (const auto& [off, times] : expected) {
    const RefinementPlan plan = plan_where_all_are_off(off);
    ASSERT_FALSE(plan.elements.empty());
    ASSERT_EQ(plan.times.size(), plan.elements.size());
    EXPECT_EQ(std::ranges::min(plan.times), times) << off;
    EXPECT_EQ(std::ranges::max(plan.times), times) << off;
  }
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
