#include "meshing/discontinuity/curve_search.h"

#include "meshing/discontinuity/search_budget.h"
#include "tests/support/lit_scene.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

// What a search is expected to take, against what it takes.

namespace halfshade {
namespace {

using test::LitScene;
using test::SceneMaker;

SceneMaker boxes_on_a_floor(int count, std::uint64_t seed) {
  test::Random random(seed);
  SceneMaker maker = SceneMaker().square_light().floor();
  for (int k = 0; k < count; ++k) {
    const Vec3 low = random.in_box({-1.8, -1.8, 0.001}, {1.6, 1.6, 0.002});
    maker.box(low, low + random.in_box({0.05, 0.05, 0.1}, {0.2, 0.2, 0.6}));
  }
  return maker;
}

struct Told {
  SearchForecast forecast;
  Discontinuities found;

  double curves() const {
    const auto& kinds = found.report.found;
    return static_cast<double>(std::accumulate(kinds.begin(), kinds.end(), std::size_t{0}));
  }
};

std::vector<int> all_surfaces(const LitScene& lit) {
  std::vector<int> all(lit.scene.surfaces.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Told tell(const LitScene& lit, std::vector<LightSource> sources) {
  DiscontinuityOptions options;
  options.horizon = false;
  return {forecast_search(lit.scene, lit.opaque, sources, all_surfaces(lit), options),
          find_discontinuities(lit.scene, lit.opaque, sources, options)};
}

LightSource source_of(const LitScene& lit) { return {lit.emitter_scene.emitter, 1}; }

TEST(ForecastSearch, IsRightToAFactorOfTwoInRoomsOfBoxes) {
  for (const int count : {5, 30, 120}) {
    const LitScene lit(boxes_on_a_floor(count, 3));
    const Told told = tell(lit, {source_of(lit)});
    EXPECT_GT(told.forecast.work, 0.5 * told.found.report.work) << count;
    EXPECT_LT(told.forecast.work, 2 * told.found.report.work) << count;
    EXPECT_GT(told.forecast.curves, 0.5 * told.curves()) << count;
    EXPECT_LT(told.forecast.curves, 2 * told.curves()) << count;
    EXPECT_GT(told.forecast.look, 0.5);
  }
}

TEST(ForecastSearch, OfFewEdgesLooksAtAll) {
  const LitScene lit(SceneMaker().square_light().floor().up({-0.3, -0.3}, {0.3, 0.3}, 1));
  const Told told = tell(lit, {source_of(lit)});
  EXPECT_EQ(told.forecast.curves, told.curves());
}

TEST(ForecastSearch, OfManySourcesLooksAtSome) {
  const LitScene lit(boxes_on_a_floor(10, 4));
  const LightSource source = source_of(lit);
  const DiscontinuityOptions options;
  const std::vector<LightSource> one = {source}, many(12, source);
  const SearchForecast of_one =
      forecast_search(lit.scene, lit.opaque, one, all_surfaces(lit), options);
  const SearchForecast of_many =
      forecast_search(lit.scene, lit.opaque, many, all_surfaces(lit), options);
  EXPECT_NEAR(of_many.work, 12 * of_one.work, 1e-9 * of_many.work);
  EXPECT_NEAR(of_many.curves, 12 * of_one.curves, 1e-9 * of_many.curves);
  EXPECT_NEAR(of_many.look, of_one.look, 1e-9 * of_one.look);
}

TEST(ForecastSearch, OfSomeSurfacesSeesNoOthers) {
  const LitScene lit(boxes_on_a_floor(4, 3));
  SceneMaker maker = boxes_on_a_floor(4, 3);
  for (int k = 0; k < 20; ++k) maker.box({8, 0.2 * k, 0}, {8.1, 0.2 * k + 0.1, 0.5});
  const LitScene more(maker);
  std::vector<int> near;
  for (const int s : all_surfaces(more)) {
    const Surface& surface = more.scene.surfaces[at(s)];
    if (surface.frame.to_space(surface.rings[0][0]).norm() < 6) near.push_back(s);
  }
  ASSERT_EQ(near.size(), lit.scene.surfaces.size());
  const std::vector<LightSource> source = {source_of(more)};
  const SearchForecast alone = tell(lit, {source_of(lit)}).forecast;
  const SearchForecast among_more = forecast_search(more.scene, more.opaque, source, near);
  EXPECT_NEAR(among_more.work, alone.work, 0.03 * alone.work) << "lines pass the others, too";
  EXPECT_NEAR(among_more.curves, alone.curves, 0.02 * alone.curves) << "but for what ends there";
  const SearchForecast of_all =
      forecast_search(more.scene, more.opaque, source, all_surfaces(more));
  EXPECT_GT(std::abs(of_all.work - alone.work), 0.1 * alone.work);
}

TEST(SpreadJobs, AreDistinctAndHaveNoPeriod) {
  EXPECT_EQ(spread_jobs(3, 16), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(spread_jobs(0, 16).empty());
  for (const std::size_t count : {17u, 65u, 1000u, 12345u}) {
    const std::vector<std::size_t> jobs = spread_jobs(count, 64);
    EXPECT_TRUE(std::is_sorted(jobs.begin(), jobs.end()));
    EXPECT_EQ(std::set<std::size_t>(jobs.begin(), jobs.end()).size(), jobs.size());
    EXPECT_LT(jobs.back(), count);
    EXPECT_GE(jobs.size(), std::min<std::size_t>(count, 64) / 2);
  }
  // The twelve edges of a box come one after the other.
  std::set<std::size_t> kinds;
  for (const std::size_t job : spread_jobs(768, 64)) kinds.insert(job % 12);
  EXPECT_EQ(kinds.size(), 12u);
}

}  // namespace
}  // namespace halfshade
