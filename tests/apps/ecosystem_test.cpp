#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// Debian's, for which the packages are.
const std::string python = "/usr/bin/python3";

// The same is asked of every file in tests/support/vtk_structure.h, without Python.
TEST(Ecosystem, MeshioAndVtkReadEveryKindOfFile) {
  const test::TempDir folder;
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> line = {test::program};
    line.insert(line.end(), arguments.begin(), arguments.end());
    const test::Outcome outcome = test::run_program(line, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  const test::Outcome imports =
      test::run_program({python, "-c", "import meshio, vtk"}, folder.path());
  if (imports.exit_code != 0) GTEST_SKIP() << "needs python3-meshio and python3-vtk9";
  const std::string s1 = test::data_file("s1.obj").string();
  run({"solve", s1, "--elements", "100", "-q", "-o", "s.vtu", "-o", "s.vtp", "-o", "s.ply", "-o",
       "s.png"});
  run({"mesh", s1, "-q", "-o", "m.vtu", "-o", "m.vtp", "-o", "m.ply", "--curves", "c.vtp"});
  run({"probe", s1, "--grid", "receiver", "--spacing", "0.5", "--direct", "-q", "-o", "p.vtp"});
  const test::Outcome outcome = test::run_program(
      {python, std::string(test::sources_folder) + "/tests/apps/ecosystem.py", "s.vtu", "s.vtp",
       "s.ply", "s.png", "m.vtu", "m.vtp", "m.ply", "c.vtp", "p.vtp"},
      folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.out, "read 9\n");
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace halfshade
