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
