#include "meshing/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace halfshade {
namespace {

TEST(ParallelFor, RunsEveryIndexOnce) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{10000}}) {
    std::vector<std::atomic<int>> runs(count);
    EXPECT_TRUE(parallel_for(count, [&](std::size_t i) { ++runs[i]; }));
    for (const auto& n : runs) EXPECT_EQ(n.load(), 1);
  }
}

TEST(ParallelFor, GivesTheResultsOfALoop) {
  constexpr std::size_t count = 20000;
  const auto value = [](std::size_t i) { return std::sin(static_cast<double>(i)); };
  std::vector<double> expected(count), result(count);
  for (std::size_t i = 0; i < count; ++i) expected[i] = value(i);
  for (int run = 0; run < 3; ++run) {
    parallel_for(count, [&](std::size_t i) { result[i] = value(i); });
    EXPECT_EQ(result, expected);
  }
}

TEST(ParallelFor, NestsWithoutDeadlock) {
  std::vector<std::vector<int>> table(50, std::vector<int>(50));
  parallel_for(50, [&](std::size_t i) {
    parallel_for(50, [&](std::size_t k) { table[i][k] = static_cast<int>(i * k); });
  });
  for (std::size_t i = 0; i < 50; ++i)
    for (std::size_t k = 0; k < 50; ++k) EXPECT_EQ(table[i][k], static_cast<int>(i * k));
}

TEST(ParallelFor, PassesAnExceptionOn) {
  const auto run = [] {
    parallel_for(1000, [](std::size_t i) {
      if (i == 567) throw std::runtime_error("index 567");
    });
  };
  try {
    run();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "index 567");
  }
}

TEST(ParallelFor, DoesNothingOnceStopped) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress;
  progress.stop = stop.get_token();
  std::atomic<int> runs{0};
  EXPECT_FALSE(parallel_for(
      1000, [&](std::size_t) { ++runs; }, progress));
  EXPECT_EQ(runs.load(), 0);
}

TEST(ParallelFor, LeavesOffSoonAfterAStopAndSaysSo) {
  std::stop_source stop;
  Progress progress;
  progress.stop = stop.get_token();
  std::atomic<int> runs{0};
  EXPECT_FALSE(parallel_for(
      1000000,
      [&](std::size_t) {
        if (++runs == 10) stop.request_stop();
      },
      progress));
  // Each thread may finish the index it is at.
  EXPECT_LE(runs.load(), 10 + static_cast<int>(std::thread::hardware_concurrency()));
}

TEST(ParallelFor, IsCompleteIfTheStopComesAfterTheLastIndex) {
  std::stop_source stop;
  Progress progress;
  progress.stop = stop.get_token();
  EXPECT_TRUE(parallel_for(
      1, [&](std::size_t) { stop.request_stop(); }, progress));
}

TEST(ParallelFor, ReportsFractionsUnderTheStagesNameNeverTwoAtOnce) {
  std::mutex reporting;
  bool at_once = false;
  std::vector<double> fractions;
  Progress progress;
  progress.report = [&](std::string_view stage, double fraction) {
    const std::unique_lock lock(reporting, std::try_to_lock);
    if (!lock) {
      at_once = true;
      return;
    }
    EXPECT_EQ(stage, "counting");
    fractions.push_back(fraction);
  };
  parallel_for(
      5000, [](std::size_t) {}, progress, "counting");
  EXPECT_FALSE(at_once);
  ASSERT_FALSE(fractions.empty());
  for (const double f : fractions) {
    EXPECT_GT(f, 0);
    EXPECT_LE(f, 1);
  }
}

}  // namespace
}  // namespace halfshade
