// What a user stops, and what stops by itself, leaves whole files, and says what is partial.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

const std::string hundred_lights = test::data_file("hundred_lights.obj").string();
const std::string bars = test::data_file("bars.obj").string();

/// A run that takes much longer than the test.
std::vector<std::string> long_probe() {
  return {test::program, "probe",    hundred_lights, "--grid",  "floor",  "--spacing",
          "0.02",        "--direct", "-o",           "old.csv", "--json", "old.json"};
}

TEST(Signals, TwoWithinASecondAreOne) {
  const test::TempDir folder;
  const pid_t child = test::start_program(long_probe(), folder.path());
  std::this_thread::sleep_for(milliseconds(3000));  // some points are done then
  kill(child, SIGINT);
  std::this_thread::sleep_for(milliseconds(20));
  kill(child, SIGTERM);
  const test::Outcome outcome = test::wait_for(child, folder.path());
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("points were computed and written"), std::string::npos) << outcome.err;
  EXPECT_EQ(test::contents(folder.path() / "old.csv").substr(0, 14), "# interrupted:");
}

TEST(Signals, TooEarlyForAResultKeepsWhatWasThere) {
  const std::vector<std::vector<std::string>> commands = {
      long_probe(),
      {test::program, "solve", hundred_lights, "-o", "old.csv.vtu", "--json", "old.json"},
      {test::program, "render", hundred_lights, "-o", "old.png", "--width", "8000", "--json",
       "old.json"}};
  for (const auto& command : commands) {
    const test::TempDir folder;
    for (const char* name : {"old.csv", "old.csv.vtu", "old.png", "old.json"})
      folder.write(name, "old");
    const test::Outcome outcome = test::run_program(command, folder.path(), milliseconds(40));
    if (outcome.exit_code == -1) continue;  // it had not begun to listen
    EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("nothing was written"), std::string::npos) << outcome.err;
    for (const char* name : {"old.csv", "old.csv.vtu", "old.png", "old.json"})
      EXPECT_EQ(test::contents(folder.path() / name), "old") << command[1];
  }
}

TEST(Signals, APictureThatIsNotFinishedIsNotWritten) {
  const test::TempDir folder;
  folder.write("old.png", "old");
  const test::Outcome outcome =
      test::run_program({test::program, "render", hundred_lights, "-o", "old.png", "--width",
                         "4000", "--height", "4000", "--samples", "64"},
                        folder.path(), milliseconds(1000));
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_EQ(test::contents(folder.path() / "old.png"), "old");
}

TEST(Signals, WhatIsIgnoredAtTheStartStaysIgnored) {
  const test::TempDir folder;
  const std::string program = test::program;
  const std::string command = "trap '' HUP; " + program + " probe " + bars +
                              " --grid floor --spacing 0.004 --direct -q -o o.csv & "
                              "sleep 0.3; kill -HUP $!; wait $!";
  const test::Outcome outcome = test::run_program({"/bin/bash", "-c", command}, folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace halfshade
