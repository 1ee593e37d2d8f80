// What others open our files with, where it is installed.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

bool is_there(const std::string& program) { return fs::exists(program); }

class Viewers : public testing::Test {
 protected:
  test::Outcome run(const std::vector<std::string>& arguments) {
    return test::run_program(arguments, folder_.path());
  }
  test::Outcome halfshade(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::program);
    const test::Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  }
  std::string path(const std::string& name) { return (folder_.path() / name).string(); }

  test::TempDir folder_;
  const std::string s1_ = test::data_file("s1.obj").string();
};

/// Opens the page of a study with no network at all, as its console and its document tell.
TEST_F(Viewers, ChromiumOpensThePageOfAStudyWithoutAnErrorAndWithoutNetwork) {
  const std::string chromium = "/usr/bin/chromium";
  if (!is_there(chromium)) GTEST_SKIP() << "needs chromium";
  halfshade({"study", s1_, "-o", "out", "--direct", "--tolerances", "0.1,0.03", "--methods",
             "fields,fields-no-curves", "--points", "50", "-q"});
  // The page tells what it fetched, and what went wrong.
  std::ofstream(folder_.path() / "watched.html")
      << test::contents(folder_.path() / "out/study.html")
      << "<script>addEventListener('load', () => document.title = 'fetched ' + "
         "performance.getEntriesByType('resource').length);</script>\n";
  const test::Outcome outcome =
      run({chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
           "--user-data-dir=" + path("profile"), "--disable-background-networking",
           "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", "--v=0",
           "--dump-dom", "file://" + path("watched.html")});
  if (outcome.out.empty()) GTEST_SKIP() << "chromium does not start here: " << outcome.err;
  EXPECT_EQ(outcome.err.find("CONSOLE"), std::string::npos) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("<title>fetched 0</title>"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("<svg"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("fields-no-curves"));
}

TEST_F(Viewers, ParaViewShowsAResultWithItsCurves) {
  const std::string pvbatch = "/usr/bin/pvbatch", xvfb = "/usr/bin/xvfb-run";
  if (!is_there(pvbatch)) GTEST_SKIP() << "needs paraview";
  if (!std::getenv("DISPLAY") && !is_there(xvfb)) GTEST_SKIP() << "needs a display or xvfb";
  std::vector<std::string> start = {pvbatch};
  if (!std::getenv("DISPLAY")) start = {xvfb, "-a", pvbatch};
  const auto batch = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), start.begin(), start.end());
    return run(arguments);
  };
  halfshade({"solve", s1_, "--tolerance", "0.05", "-q", "-o", "a.vtu"});
  halfshade({"mesh", s1_, "-q", "-o", "m.vtu", "--curves", "c.vtp"});
  const std::string macro = std::string(test::sources_folder) + "/apps/paraview/halfshade_view.py";
  const test::Outcome outcome =
      batch({macro, "a.vtu", "--curves", "c.vtp", "--size", "300", "200", "-o", "view.png"});
  if (outcome.err.find("No module named 'paraview") != std::string::npos ||
      outcome.out.find("No module named 'paraview") != std::string::npos)
    GTEST_SKIP() << "needs python3-paraview";
  if (outcome.err.find("bad X server connection") != std::string::npos)
    GTEST_SKIP() << "the display does not work";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_GT(fs::file_size(path("view.png")), 3000u);
  const test::Outcome missing =
      batch({macro, "a.vtu", "--quantity", "brilliance", "-o", "none.png"});
  EXPECT_THAT(missing.out + missing.err, testing::HasSubstr("'brilliance'"));
  EXPECT_FALSE(fs::exists(path("none.png")));
}

}  // namespace
}  // namespace halfshade
