#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

const fs::path data = test::data_folder;
const std::string l_room = (data / "l_room.obj").string();
const std::string cube = (data / "furnace_cube.obj").string();

class Factors : public testing::Test {
 protected:
  test::Outcome factors(std::vector<std::string> arguments,
                        std::chrono::milliseconds interrupt_after = {}) {
    arguments.insert(arguments.begin(), {test::program, "factors"});
    return test::run_program(std::move(arguments), folder_.path(), interrupt_after);
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  std::string file(const std::string& name) { return test::contents(folder_.path() / name); }
  bool exists(const std::string& name) { return fs::exists(folder_.path() / name); }

  /// The rows of a table below its comments, the header first.
  std::vector<std::vector<std::string>> rows(const std::string& name) {
    std::istringstream lines(file(name));
    std::vector<std::vector<std::string>> result;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::istringstream cells(line);
      result.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) result.back().push_back(cell);
    }
    return result;
  }

  test::TempDir folder_;
};

TEST_F(Factors, AreATableByGroup) {
  const test::Outcome outcome = factors({l_room, "-o", "f.csv", "--json", "f.json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("wrote        f.csv"), std::string::npos);
  EXPECT_TRUE(file("f.csv").starts_with("# halfshade 0."));
  EXPECT_NE(file("f.csv").find("# areas in m²"), std::string::npos);
  const auto table = rows("f.csv");
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[0], (std::vector<std::string>{"surface", "area", "floor", "ceiling", "walls",
                                                "lamp", "space", "row_sum", "error"}));
  for (std::size_t i = 1; i < table.size(); ++i) {
    EXPECT_NEAR(std::stod(table[i][7]), 1, 1e-4);
    EXPECT_EQ(std::stod(table[i][6]), 0);
    EXPECT_LE(std::stod(table[i][8]), 1e-4);
    for (std::size_t j = 1; j < table.size(); ++j)
      EXPECT_NEAR(std::stod(table[i][1]) * std::stod(table[i][j + 1]),
                  std::stod(table[j][1]) * std::stod(table[j][i + 1]), 1e-14);
  }
  const auto report = nlohmann::json::parse(file("f.json"));
  EXPECT_EQ(report.at("surfaces"), 4);
  EXPECT_EQ(report.at("rows_not_reached"), 0);
  EXPECT_LT(report.at("row_sum_error_max").get<double>(), 1e-4);
  EXPECT_TRUE(report.at("enforced_by").is_null());
  EXPECT_FALSE(report.at("interrupted").get<bool>());
}

TEST_F(Factors, MatrixMarketHoldsTheSameNumbers) {
  ASSERT_EQ(factors({cube, "-o", "f.csv", "--by", "face", "-q"}).exit_code, 0);
  ASSERT_EQ(factors({cube, "-o", "f.mtx", "--by", "face", "-q"}).exit_code, 0);
  const auto table = rows("f.csv"), names = rows("f.names.csv");
  ASSERT_EQ(names.size(), 7u);
  EXPECT_EQ(names[0], (std::vector<std::string>{"surface", "area", "space", "row_sum", "error"}));
  std::istringstream lines(file("f.mtx"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
  while (lines.peek() == '%') std::getline(lines, line);
  int count = 0, columns = 0, entries = 0;
  lines >> count >> columns >> entries;
  EXPECT_EQ(count, 6);
  EXPECT_EQ(columns, 6);
  EXPECT_EQ(entries, 30) << "without the diagonal";
  for (int k = 0; k < entries; ++k) {
    std::size_t i = 0, j = 0;
    double value = 0;
    lines >> i >> j >> value;
    EXPECT_EQ(value, std::stod(table[i][j + 1]));
  }
  for (std::size_t i = 1; i < names.size(); ++i) EXPECT_EQ(names[i][0], table[i][0]);
}

TEST_F(Factors, NamesAreQuotedWhereTheyMustBe) {
  write("p.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "g a,\"b\"\nf 1 2 3 4\ng c\nf 8 7 6 5\n");
  EXPECT_EQ(factors({"p.obj", "-o", "f.csv", "-q", "--tolerance", "0.01"}).exit_code, 0);
  EXPECT_NE(file("f.csv").find("surface,area,\"a,\"\"b\"\"\",c,space,row_sum,error\n"),
            std::string::npos);
}

TEST_F(Factors, GoToTheStandardOutputAndKeepTheRestOffIt) {
  const test::Outcome outcome = factors({cube, "-o", "-", "--by", "material"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(outcome.out.starts_with("# halfshade"));
  EXPECT_EQ(outcome.out.find("pairs"), std::string::npos);
  EXPECT_NE(outcome.err.find("pairs"), std::string::npos);
}

TEST_F(Factors, ExamplesOfTheHelpRun) {
  fs::create_directory_symlink(data, folder_.path() / "data");
  const auto examples = test::examples_of(factors({"--help"}).out, "factors");
  EXPECT_GE(examples.size(), 3u);
  for (const std::vector<std::string>& arguments : examples) {
    const test::Outcome outcome = factors(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
  }
}

TEST_F(Factors, TellWhatIsSwallowedAndWhatIsNotReached) {
  const std::string s1 = (data / "s1.obj").string();
  const test::Outcome swallowed = factors({s1, "-o", "f.csv", "--tolerance", "0.01"});
  EXPECT_EQ(swallowed.exit_code, 0);
  EXPECT_NE(swallowed.err.find("backs of one-sided faces swallow"), std::string::npos);
  const test::Outcome short_of =
      factors({s1, "-o", "f.csv", "--tolerance", "1e-7", "--max-points", "50", "-q"});
  EXPECT_EQ(short_of.exit_code, 4);
  EXPECT_NE(short_of.err.find("--max-points"), std::string::npos);
  EXPECT_TRUE(exists("f.csv"));
}

TEST_F(Factors, SayInOneSentenceWhatIsWrong) {
  write("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string names;
  };
  const std::vector<Wrong> all = {
      {{"none.obj", "-o", "f.csv"}, 3, "none.obj"},
      {{cube}, 2, "--output"},
      {{cube, "-o", "f.txt"}, 2, ".txt"},
      {{cube, "-o", "f.csv", "--by", "colour"}, 2, "colour"},
      {{cube, "-o", "f.csv", "--tolerance", "0"}, 2, "--tolerance"},
      {{cube, "-o", "f.csv", "--method", "hemicubes"}, 2, "hemicubes"},
      {{cube, "-o", "f.csv", "--method", "hemicube", "--hemicube", "3"}, 2, "--hemicube"},
      {{cube, "-o", "none/f.csv"}, 5, "none"},
      {{cube, "-o", "f.mtx", "--json", "f.names.csv"}, 2, "f.names.csv"},
      {{"scene.obj", "-o", "scene.obj"}, 2, "scene.obj"},
  };
  for (const Wrong& wrong : all) {
    const test::Outcome outcome = factors(wrong.arguments);
    EXPECT_EQ(outcome.exit_code, wrong.exit_code) << testing::PrintToString(wrong.arguments);
    EXPECT_NE(outcome.err.find(wrong.names), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_FALSE(exists("f.csv"));
}

TEST_F(Factors, InterruptedWriteNothing) {
  const std::string dining_room = (data / "dining_room.obj").string();
  const test::Outcome outcome =
      factors({dining_room, "-o", "f.csv", "--tolerance", "1e-9"}, std::chrono::milliseconds(700));
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.err, "interrupted: too early for a result; nothing was written\n");
  EXPECT_FALSE(exists("f.csv"));
}

TEST_F(Factors, NeedNoEmitter) {
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(factors({"dark.obj", "-o", "f.csv", "-q"}).exit_code, 0);
  EXPECT_NEAR(std::stod(rows("f.csv")[1][3]), 1, 1e-6) << "space is all it sees";
}

}  // namespace
}  // namespace halfshade
