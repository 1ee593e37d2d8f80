#include "meshing/discontinuity/search_budget.h"

#include "meshing/repair/repair.h"
#include "tests/support/triangle_soups.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

TEST(SearchBudget, AllowsUntilItIsUsedUp) {
  SearchBudget budget(100, 10);
  EXPECT_TRUE(budget.allows(CurveKind::ev, 60));
  budget.use(60);
  EXPECT_TRUE(budget.allows(CurveKind::ev, 40));
  EXPECT_FALSE(budget.allows(CurveKind::eee, 41));
  EXPECT_EQ(budget.used(), 60);
  EXPECT_EQ(budget.left_out()[static_cast<std::size_t>(CurveKind::eee)], 41);
  EXPECT_EQ(budget.left_out()[static_cast<std::size_t>(CurveKind::ev)], 0);
}

TEST(SearchBudget, SamplesAreSpreadAndNeedlessWithoutALimit) {
  const std::vector<std::size_t> jobs = SearchBudget(1, 0).sample(1000);
  ASSERT_EQ(jobs.size(), 16u);
  EXPECT_EQ(jobs.front(), 0u);
  EXPECT_GT(jobs.back(), 900u);
  for (std::size_t k = 1; k < jobs.size(); ++k) EXPECT_GT(jobs[k], jobs[k - 1]);
  EXPECT_EQ(SearchBudget(1, 0).sample(3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(SearchBudget(HUGE_VAL, 0).sample(1000).empty());
}

TEST(SearchBudget, WhatIsSeenTakesMoreWorkBehindMoreFaces) {
  TraceCounts few, many;
  few.pieces = many.pieces = 10;
  few.crossings = 10;
  many.crossings = 200;
  EXPECT_GT(look_work(many, 1000), 5 * look_work(few, 1000));
  EXPECT_GT(look_work(many, 100000), 2 * look_work(many, 1000));
}

Discontinuities find(const SoundScene& scene, double most_work) {
  DiscontinuityOptions options;
  options.most_work = most_work;
  return find_discontinuities(scene, OpaqueScene(scene), light_sources(scene), options);
}

TEST(SearchBudget, LeavesOutKindsThatTakeTooMuchAndNothingElse) {
  const SoundScene scene = make_sound(test::unit_soup(12, 5));
  const Discontinuities all = find(scene, 0), enough = find(scene, 1e12);
  ASSERT_GT(all.report.found[static_cast<std::size_t>(CurveKind::eee)], 0u);
  EXPECT_EQ(all.report.left_out, (std::array<double, curve_kinds>{}));
  EXPECT_EQ(enough.report.left_out, all.report.left_out);
  EXPECT_EQ(enough.report.found, all.report.found) << "a sample first changes nothing";
  ASSERT_EQ(enough.curves.size(), all.curves.size());
  for (std::size_t k = 0; k < all.curves.size(); ++k) {
    EXPECT_EQ(enough.curves[k].arc.from, all.curves[k].arc.from);
    EXPECT_EQ(enough.curves[k].jump, all.curves[k].jump);
  }
  const Discontinuities none = find(scene, 10);
  EXPECT_TRUE(none.curves.empty());
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_GT(none.report.left_out[k], 0) << "kind " << k << " of " << all.report.found[k];
  EXPECT_LT(none.report.pieces, all.report.pieces / 2);
  const Discontinuities some = find(scene, 0.5 * all.report.work);
  EXPECT_GT(some.report.left_out[static_cast<std::size_t>(CurveKind::eee)], 0);
  EXPECT_LT(some.report.work, all.report.work);
}

}  // namespace
}  // namespace halfshade
