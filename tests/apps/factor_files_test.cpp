// Scenes of thermal programs go in, matrices come out that others read.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>

#include <sstream>

namespace halfshade {
namespace {

/// A table without its comments, in which the scene has a part.
std::string table_of(const std::string& scene, const std::string& by,
                     const std::string& tolerance) {
  const test::TempDir folder;
  const test::Outcome outcome =
      test::run_program({test::program, "factors", test::data_file(scene).string(), "-o", "f.csv",
                         "-q", "--by", by, "--tolerance", tolerance},
                        folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string text = test::contents(folder.path() / "f.csv");
  return text.substr(text.find("surface,"));
}

TEST(FactorFiles, TwinsInOtherFormatsGiveTheSameMatrix) {
  for (const std::string by : {"group", "face"}) {
    const std::string table = table_of("two_squares.obj", by, "1e-5");
    EXPECT_EQ(table_of("two_squares.vs3", by, "1e-5"), table);
    EXPECT_EQ(table_of("two_squares.msh", by, "1e-5"), table);
  }
}

TEST(FactorFiles, ObstructedSquaresAreAsTheirPageDerives) {
  std::istringstream lines(table_of("two_squares.vs3", "group", "1e-8"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "surface,area,low,high,between,space,row_sum,error");
  const double low_high = 0.0995062945989848, between_high = 0.517653079515534;
  const double expected[3][3] = {
      {0, low_high, 0}, {low_high, 0, between_high / 4}, {0, between_high, 0}};
  for (const auto& row : expected) {
    std::getline(lines, line);
    std::istringstream cells(line);
    std::string cell;
    for (int k = 0; k < 2; ++k) std::getline(cells, cell, ',');
    for (const double value : row) {
      std::getline(cells, cell, ',');
      EXPECT_NEAR(std::stod(cell), value, 1e-8);
    }
  }
}

TEST(FactorFiles, OfAnotherSceneAreRefused) {
  const test::TempDir folder;
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {test::program};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return test::run_program(all, folder.path());
  };
  // A cold plate under a warm one; then it is moved aside, and the matrix says nothing of it.
  const auto scene = [](const std::string& x) {
    return "mtllib m.mtl\nv 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\nv " + x + " 0 0\nv 1" + x +
           " 0 0\nv 1" + x + " 1 0\nv " + x + " 1 0\nusemtl m\nf 1 2 3 4\nf 5 6 7 8\n";
  };
  folder.write("m.mtl", "newmtl m\nemissivity 0.5\ntemperature 300\n");
  folder.write("plates.obj", scene(".0"));
  folder.write("moved.obj", scene(".5"));
  ASSERT_EQ(run({"factors", "plates.obj", "--by", "face", "-o", "f.mtx"}).exit_code, 0);
  EXPECT_EQ(run({"solve", "plates.obj", "--factors", "f.mtx", "-o", "o.vtu"}).exit_code, 0);
  const auto by_method = [&](const std::string& method) {
    return run({"solve", "plates.obj", "--factors", "f.mtx", "-o", "o.vtu", "--method", method});
  };
  EXPECT_EQ(by_method("matrix").exit_code, 0) << "that is what they are";
  EXPECT_EQ(by_method("fields").exit_code, 2);
  std::string text = test::contents(folder.path() / "f.mtx");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"solve", "moved.obj", "--factors", "f.mtx", "-o", "o.vtu"},
        std::vector<std::string>{"factors", "moved.obj", "--from", "f.mtx", "-o", "o.csv"}}) {
    const test::Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("f.mtx: 'face 2' has its centre at (0.5, 0.5, 0)"),
              std::string::npos)
        << outcome.err;
  }
  for (std::size_t k = text.find(" 0.1998"); k != std::string::npos; k = text.find(" 0.1998"))
    text.replace(k, 7, " 0.2998");
  folder.write("f.mtx", text);
  const test::Outcome changed = run({"solve", "plates.obj", "--factors", "f.mtx", "-o", "o.vtu"});
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_NE(changed.err.find("'face 1' and its space add up to 1.1"), std::string::npos)
      << changed.err;
}

// By scipy where it is installed, else by numpy alone.
TEST(FactorFiles, PythonReadsTheSameBits) {
  const test::TempDir folder;
  const std::string python = "/usr/bin/python3";
  const auto run = [&](const std::vector<std::string>& arguments) {
    const test::Outcome outcome = test::run_program(arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  if (test::run_program({python, "-c", "import numpy"}, folder.path()).exit_code != 0)
    GTEST_SKIP() << "needs python3-numpy";
  for (const char* file : {"f.csv", "f.mtx"})
    run({test::program, "factors", test::data_file("l_room.obj").string(), "-q", "--by", "face",
         "-o", file});
  std::istringstream numbers(
      run({python, std::string(test::sources_folder) + "/tests/apps/factor_matrices.py", "f.csv",
           "f.mtx"}));
  std::istringstream lines(test::contents(folder.path() / "f.csv"));
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#') || line.starts_with("surface,")) continue;
    std::istringstream cells(line);
    std::string cell, number;
    std::getline(cells, cell, ',');
    for (; std::getline(cells, cell, ','); ++count) {
      numbers >> number;
      EXPECT_EQ(std::stod(number), std::stod(cell));
    }
  }
  EXPECT_EQ(count, 9 * 13);
}

}  // namespace
}  // namespace halfshade
