#include "solver/pipeline/solve.h"
#include "tests/support/cornell.h"
#include "tests/support/has_warning.h"
#include "tests/support/mean_irradiance.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

// What a solve that is stopped at its form factors has to show.

namespace halfshade {
namespace {

SolveOptions coarse() {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 1500;
  options.discontinuities = false;
  return options;
}

/// Stopped once so much of the form factors is done.
SolveResult solve_until(const Scene& scene, double fraction) {
  std::stop_source stop;
  const auto report = [&](std::string_view stage, double done) {
    if (stage == "form factors" && done >= fraction) stop.request_stop();
  };
  return solve(scene, coarse(), {stop.get_token(), report});
}

double distance(const SolveResult& a, const SolveResult& b) {
  const Eigen::Map<const Eigen::ArrayXd> area(a.elements.area.data(), a.elements.count());
  const ChannelArray difference = a.solution.irradiance - b.solution.irradiance;
  return std::sqrt((area * difference.square().rowwise().mean()).sum() /
                   (area * b.solution.irradiance.square().rowwise().mean()).sum());
}

/// Open, as it comes: light leaves through its front.
Scene open_room() { return test::cornell_box(); }

/// Half of its light comes back.
Scene closed_room() {
  Scene scene = test::l_room(true);
  scene.materials[1].exitance = Rgb(100, 80, 60);
  return scene;
}

class InterruptedSolve : public testing::TestWithParam<std::tuple<bool, double>> {};

TEST_P(InterruptedSolve, IsAsBrightAsACompleteOne) {
  const auto& [is_open, fraction] = GetParam();
  const Scene scene = is_open ? open_room() : closed_room();
  const SolveResult complete = solve(scene, coarse()), part = solve_until(scene, fraction);
  ASSERT_EQ(part.elements.count(), complete.elements.count());
  EXPECT_TRUE(part.interrupted);
  EXPECT_FALSE(part.exchange.complete);
  EXPECT_GT(part.exchange.estimated_share, 0);
  // Rows shrink towards the last one, and those may be done first.
  EXPECT_LT(part.exchange.estimated_share, 1.1 - fraction * fraction);
  EXPECT_TRUE(test::has_warning(part, Warning::Kind::exchange_estimated));
  EXPECT_NEAR(test::mean_irradiance(part).mean(), test::mean_irradiance(complete).mean(),
              0.02 * test::mean_irradiance(complete).mean());
  // Nothing is left dark.
  EXPECT_GT((part.solution.irradiance / complete.solution.irradiance).minCoeff(), 0.3);
  const double error = distance(part, complete);
  EXPECT_LT(error, 0.1);
  EXPECT_GT(part.relative_error, error) << "the estimate knows of it";
  EXPECT_LT(part.relative_error, complete.relative_error + 5 * error);
  EXPECT_TRUE((part.solution.error_estimate >= 0).all());
  for (const ChannelReport& channel : part.radiosity.channel) EXPECT_LT(channel.balance, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Moments, InterruptedSolve,
                         testing::Combine(testing::Bool(), testing::Values(0., 0.3, 0.7, 0.95)));

TEST(InterruptedSolveEnds, OneThatIsCompleteHasNoEstimates) {
  const SolveResult result = solve(closed_room(), coarse());
  EXPECT_TRUE(result.exchange.complete);
  EXPECT_EQ(result.exchange.estimated_share, 0);
  EXPECT_FALSE(test::has_warning(result, Warning::Kind::exchange_estimated));
}

/// Stopped when reflected light is solved for once more, or, if at once, for the first time.
SolveResult solve_one_round(const Scene& scene, ReflectedVisibility visibility, bool at_once) {
  std::stop_source stop;
  bool is_estimated = at_once;
  const auto report = [&](std::string_view stage, double) {
    if (stage == "error of reflected light") is_estimated = true;
    const bool is_first =
        stage == "exact parts of reflected light" || stage == "rays of reflected light";
    if (is_first && is_estimated) stop.request_stop();
  };
  SolveOptions options;
  options.tolerance = 0.002;
  options.visibility = visibility;
  return solve(scene, options, {stop.get_token(), report});
}

TEST(InterruptedFields, KeepTheReflectedLightOfTheLastRound) {
  const Scene scene = test::cornell_box();
  const SolveResult complete = solve(scene, {}),
                    part = solve_one_round(scene, ReflectedVisibility::exact, false);
  EXPECT_TRUE(part.interrupted);
  EXPECT_EQ(part.reflected.rounds, 1);
  EXPECT_GE(part.relative_error, part.reflected.error);
  EXPECT_NEAR(test::mean_irradiance(part).mean(), test::mean_irradiance(complete).mean(),
              0.02 * test::mean_irradiance(complete).mean());
}

TEST(InterruptedFields, FindReflectedLightCoarselyWhereTheFirstRoundIsStopped) {
  const Scene scene = test::cornell_box();
  const double complete = test::mean_irradiance(solve(scene, {})).mean();
  for (const auto visibility : {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
    const SolveResult part = solve_one_round(scene, visibility, true);
    EXPECT_TRUE(part.interrupted);
    EXPECT_EQ(part.reflected.rounds, 1);
    const double off = std::abs(test::mean_irradiance(part).mean() / complete - 1);
    EXPECT_LT(off, 0.05);
    EXPECT_GT(part.relative_error, off);
    EXPECT_LT(part.relative_error, 0.3);
  }
}

}  // namespace
}  // namespace halfshade
