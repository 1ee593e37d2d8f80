#include "io/study/child_process.h"

#include "tests/support/expect_error.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <thread>

namespace halfshade {
namespace {

const std::vector<std::string> shell = {"/bin/sh", "-c"};

ChildEnd run(const std::string& command, const std::filesystem::path& log, double limit = 0,
             const std::stop_token& stop = {}) {
  std::vector<std::string> words = shell;
  words.push_back(command);
  return run_child(words, {log, limit}, stop);
}

TEST(ChildProcess, TellsHowItEnded) {
  const test::TempDir folder;
  const auto log = folder.path() / "log";
  const ChildEnd end = run("echo out; echo err >&2; exit 7", log);
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_FALSE(end.timed_out || end.stopped);
  EXPECT_EQ(test::contents(log), "out\nerr\n");
  EXPECT_EQ(run("kill -9 $$", log).exit_code, -1);
  EXPECT_EQ(run_child({"/nowhere/at/all"}, {log, 0}, {}).exit_code, 127);
  test::expect_error([&] { run("true", folder.path() / "none" / "log"); }, ErrorCode::unwritable,
                     {"log"});
}

TEST(ChildProcess, MeasuresTimeAndMemory) {
  const test::TempDir folder;
  const auto log = folder.path() / "log";
  const ChildEnd idle = run("sleep 0.3", log);
  EXPECT_GE(idle.seconds, 0.3);
  EXPECT_LT(idle.cpu_seconds, 0.2);
  const ChildEnd busy =
      run("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done", folder.path() / "log");
  EXPECT_GT(busy.cpu_seconds, 0.02);
  EXPECT_GT(busy.peak_memory_bytes, 100000u);
}

TEST(ChildProcess, IsEndedInTime) {
  const test::TempDir folder;
  const auto log = folder.path() / "log";
  const ChildEnd late = run("exec sleep 60", log, 0.1);
  EXPECT_TRUE(late.timed_out);
  EXPECT_LT(late.seconds, 30);
  const ChildEnd deaf = run("trap '' TERM; while :; do sleep 0.05; done", log, 0.1);
  EXPECT_TRUE(deaf.timed_out);
  EXPECT_EQ(deaf.exit_code, -1) << "killed";
  std::stop_source stop;
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  const ChildEnd stopped = run("exec sleep 60", log, 0, stop.get_token());
  EXPECT_TRUE(stopped.stopped);
  EXPECT_FALSE(stopped.timed_out);
  EXPECT_LT(stopped.seconds, 30);
}

}  // namespace
}  // namespace halfshade
