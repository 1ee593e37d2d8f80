// Files of the user are worth more than results: nothing that is read is ever written, and what
// cannot be written whole leaves what was there.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <sys/resource.h>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

/// A folder with a small scene and everything that may belong to one.
class FileSafety : public testing::Test {
 protected:
  FileSafety() {
    for (const char* name : {"s1.obj", "s1.mtl", "s1.json"})
      folder_.write(name, test::contents(test::data_file(name)));
    folder_.write("points.csv", test::contents(test::data_file("s1_points.csv")));
    folder_.write("materials.json", R"({"receiver": {"reflectance": 0.3}})");
    folder_.write("old.vtu", "old");
    folder_.write("old.json", "old");
    fs::create_symlink("s1.mtl", path("link.ply"));
    fs::create_hard_link(path("s1.mtl"), path("hard.json"));
    fs::create_symlink("new.vtu", path("dangling.vtu"));
    fs::create_directory(path("sub"));
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  test::Outcome run(Arguments arguments) {
    arguments.insert(arguments.begin(), test::program);
    return test::run_program(std::move(arguments), folder_.path());
  }

  /// Every file with its bytes, but for what run_program leaves.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.is_regular_file() && !entry.path().filename().string().starts_with(".std"))
        files[entry.path().string()] = test::contents(entry.path());
    return files;
  }

  test::TempDir folder_;
};

TEST_F(FileSafety, OutputsAreNeverInputsOrOtherOutputs) {
  struct Case {
    Arguments arguments;
    std::string one, other;  ///< what the sentence names
  };
  const Case cases[] = {
      {{"solve", "s1.obj", "--json", "s1.obj"}, "--json", "SCENE"},
      {{"solve", "s1.obj", "--json", "./sub/../s1.obj"}, "--json", "SCENE"},
      {{"solve", "s1.obj", "--json", "s1.json"}, "--json", "sidecar"},
      {{"solve", "s1.obj", "--json", "s1.mtl"}, "--json", "s1.mtl"},
      {{"solve", "s1.obj", "--json", "hard.json"}, "--json", "s1.mtl"},
      {{"solve", "s1.obj", "-o", "link.ply"}, "-o", "s1.mtl"},
      {{"solve", "s1.obj", "--materials", "materials.json", "--json", "materials.json"},
       "--json",
       "--materials"},
      {{"solve", "s1.obj", "-o", "a.vtu", "-o", "sub/../a.vtu"}, "-o", "a.vtu"},
      {{"solve", "s1.obj", "-o", "dangling.vtu", "-o", "new.vtu"}, "-o", "dangling.vtu"},
      {{"mesh", "s1.obj", "-o", "a.vtp", "--curves", "a.vtp"}, "-o", "--curves"},
      {{"mesh", "s1.obj", "--picture", "a.png", "--json", "a.png"}, "--picture", "--json"},
      {{"probe", "s1.obj", "--points", "points.csv", "-o", "points.csv"}, "-o", "--points"},
      {{"probe", "s1.obj", "--points", "points.csv", "-o", "-", "--json", "-"}, "-o", "--json"},
      {{"probe", "s1.obj", "--points", "points.csv", "-o", "o.csv", "--json", "points.csv"},
       "--json",
       "--points"},
      {{"render", "old.vtu", "-o", "a.png", "--json", "old.vtu"}, "--json", "INPUT"},
      {{"render", "s1.obj", "-o", "a.png", "--json", "s1.json"}, "--json", "sidecar"}};
  const auto before = everything();
  for (const Case& c : cases) {
    const test::Outcome outcome = run(c.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(c.one), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(c.other), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(everything(), before) << outcome.err;
  }
}

TEST_F(FileSafety, ASidecarThatIsNotThereYetIsNotWrittenEither) {
  // The next run would read the report as the scene's sidecar.
  fs::remove(path("s1.json"));
  EXPECT_EQ(run({"solve", "s1.obj", "--json", "s1.json", "-q"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(path("s1.json")));
}

TEST_F(FileSafety, AReportIsNotReadAsASidecar) {
  ASSERT_EQ(run({"solve", "s1.obj", "--elements", "20", "-q", "--json", "r.json"}).exit_code, 0);
  fs::rename(path("r.json"), path("s1.json"));
  const test::Outcome outcome = run({"solve", "s1.obj", "--elements", "20", "-q"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("s1.json: this is a report"), std::string::npos) << outcome.err;
}

TEST_F(FileSafety, DevicesMayBeNamedTwice) {
  EXPECT_EQ(run({"probe", "s1.obj", "--points", "points.csv", "-o", "o.csv", "--json", "/dev/null",
                 "--direct", "-q"})
                .exit_code,
            0);
}

/// Runs in a process of its own whose files may not become longer than `bytes`.
test::Outcome run_limited(const Arguments& arguments, const fs::path& folder, rlim_t bytes) {
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit limit{bytes, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  const test::Outcome outcome = test::run_program(arguments, folder);
  setrlimit(RLIMIT_FSIZE, &old);
  return outcome;
}

TEST_F(FileSafety, WhatDoesNotFitLeavesWhatWasThere) {
  const auto before = everything();
  const Arguments commands[] = {{"solve", "s1.obj", "--elements", "400", "-q", "-o", "old.vtu"},
                                {"mesh", "s1.obj", "-q", "-o", "old.vtu"},
                                {"probe", "s1.obj", "--grid", "receiver", "--spacing", "0.1",
                                 "--direct", "-q", "-o", "points.csv"},
                                {"render", "s1.obj", "-q", "-o", "old.png"},
                                {"probe", "s1.obj", "--grid", "receiver", "--spacing", "1",
                                 "--direct", "-q", "-o", "-", "--json", "/dev/full"}};
  for (Arguments arguments : commands) {
    arguments.insert(arguments.begin(), test::program);
    const test::Outcome outcome = run_limited(arguments, folder_.path(), 2000);
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    EXPECT_NE(outcome.err.find("cannot be written"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(everything(), before) << outcome.err;
  }
}

TEST_F(FileSafety, ProtectedFilesAndFoldersAreToldAtOnce) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(path("old.vtu"), fs::perms::owner_read);
  fs::permissions(path("sub"), fs::perms::owner_read | fs::perms::owner_exec);
  for (const char* name : {"old.vtu", "sub/a.vtu"}) {
    const test::Outcome outcome = run({"solve", "s1.obj", "-q", "-o", name});
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(test::contents(path("old.vtu")), "old");
  fs::permissions(path("sub"), fs::perms::owner_all);
}

TEST_F(FileSafety, AStandardOutputThatTakesNothingIsTold) {
  const std::string program = test::program;
  const std::string probe = " probe s1.obj --points points.csv --direct -o ";
  for (const std::string& command :
       {program + probe + "- | true; exit ${PIPESTATUS[0]}", program + probe + "o.csv >/dev/full",
        program + probe + "o.csv >&-", program + probe + "- >/dev/full"}) {
    const test::Outcome outcome = test::run_program({"/bin/bash", "-c", command}, folder_.path());
    // A pipe may take all before its other end closes.
    if (command.find("true") != std::string::npos && outcome.exit_code == 0) continue;
    EXPECT_EQ(outcome.exit_code, 5) << command << outcome.err;
    EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace halfshade
