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

const fs::path scene_folder = test::data_folder;
const std::string l_room = (scene_folder / "l_room.obj").string();
const std::string cube = (scene_folder / "furnace_cube.obj").string();

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
  EXPECT_EQ(names[0],
            (std::vector<std::string>{"surface", "area", "space", "row_sum", "error", "left_out",
                                      "centre_x", "centre_y", "centre_z", "normal_x", "normal_y",
                                      "normal_z", "extent_x", "extent_y", "extent_z"}));
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

TEST_F(Factors, TellWhatWasPutRight) {
  write("rug.obj",
        "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv .5 .25 0\nv 1.5 .25 0\nv 1.5 .75 0\nv .5 .75 0\n"
        "v 3 0 0\nv 3 1 0\ng floor\nf 1 2 3 4\ng rug\nf 5 6 7 8\ng floor\nf 2 9 10 3\n");
  const std::string cut =
      "face 2 (line 14) and face 1 (line 12) lie in one plane and cover each other over an area of "
      "0.5, which face 2 (line 14) keeps";
  const test::Outcome said = factors({"rug.obj", "-o", "f.csv"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("note: " + cut + "\n"), std::string::npos) << said.err;
  EXPECT_EQ(said.err.find("warning"), std::string::npos) << "a rug is what its maker wanted";
  EXPECT_EQ(said.out.find("repair"), std::string::npos);
  const test::Outcome all = factors({"rug.obj", "-o", "f.csv", "-v", "--json", "f.json"});
  EXPECT_NE(all.out.find("repair       " + cut + "\n"), std::string::npos) << all.out;
  EXPECT_NE(all.out.find("were joined\n"), std::string::npos) << all.out;
  const auto repairs = nlohmann::json::parse(file("f.json")).at("repairs");
  ASSERT_EQ(repairs.size(), 2U);
  for (const auto& repair : repairs)
    EXPECT_NE(all.out.find(repair.at("sentence").get<std::string>()), std::string::npos);
  ASSERT_EQ(factors({"rug.obj", "-o", "f.mtx", "--by", "face", "-q"}).exit_code, 0);
  const test::Outcome from = factors({"rug.obj", "--from", "f.mtx", "-o", "g.csv", "-v"});
  EXPECT_NE(from.out.find("repair       " + cut + "\n"), std::string::npos) << from.out;
  EXPECT_EQ(factors({cube, "-o", "f.csv"}).err.find("making the scene sound"), std::string::npos);
}

TEST_F(Factors, WarnOfFacesThatWereLostOrMoved) {
  const auto warned = [&](const std::string& name, const std::string& text,
                          const std::string& says) {
    write(name, text);
    const test::Outcome outcome = factors({name, "-o", "f.csv", "--by", "face"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.err.find("warning: making the scene sound may have changed its form "
                               "factors: " +
                               says),
              std::string::npos)
        << outcome.err;
  };
  warned("twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n",
         "face 2 (line 5) has the same corners as face 1");
  warned("off.obj",
         "v 1000 0 0\nv 1002 0 0\nv 1002 1 0\nv 1000 1 0\nv 1000.5 .25 .0001\n"
         "v 1001.5 .25 .0001\nv 1001.5 .75 .0001\nv 1000.5 .75 .0001\nf 1 2 3 4\nf 5 6 7 8\n",
         "face 2 (line 10) and face 1 (line 9) lie in one plane and cover each other over an area "
         "of 0.5, which face 2 (line 10) keeps, for they are no more than 0.0001 apart\n");
  warned("across.obj",
         "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 .25 0\nv 3 .25 0\nv 3 .75 0\nv 1 .75 0\n"
         "f 1 2 3 4\nf 5 6 7 8\n",
         "face 2 (line 10) and face 1 (line 9) lie in one plane and cover each other over an area "
         "of 0.5, which face 2 (line 10) keeps\n");
}

TEST_F(Factors, TellGroupsThatHaveNoRow) {
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\ng flat\nf 1 2 4\ng full\nf 1 2 3\n");
  const std::string note =
      "note: 'flat' has no row: none of its faces was left when the scene was made sound\n";
  const test::Outcome by_group = factors({"flat.obj", "-o", "f.csv"});
  EXPECT_EQ(by_group.exit_code, 0);
  EXPECT_NE(by_group.err.find(note), std::string::npos) << by_group.err;
  ASSERT_EQ(rows("f.csv").size(), 2u);
  EXPECT_EQ(rows("f.csv")[1][0], "full");
  for (const std::string unit : {"material", "face"})
    EXPECT_EQ(factors({"flat.obj", "-o", "f.csv", "--by", unit}).err.find("has no row"),
              std::string::npos);
}

TEST_F(Factors, TellGroupsWithoutFaces) {
  write("names.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng some thing\ng\ng full\nf 1 2 3\ng other\n");
  const test::Outcome by_group = factors({"names.obj", "-o", "f.csv"});
  EXPECT_EQ(by_group.exit_code, 0);
  EXPECT_NE(by_group.err.find("note: 'other', 'some thing' have no rows: the file gives "
                              "them no faces\n"),
            std::string::npos)
      << by_group.err;
  for (const std::string unit : {"material", "face"})
    EXPECT_EQ(factors({"names.obj", "-o", "f.csv", "--by", unit}).err.find("have no rows"),
              std::string::npos);
}

TEST_F(Factors, TellWhatWasLeftOutAndScaled) {
  const std::vector<std::string> sparse = {l_room,  "--by",           "face", "-o",
                                           "f.mtx", "--sparse-below", "0.05"};
  const auto with = [](std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const test::Outcome plain = factors(with(sparse, {"--json", "f.json"}));
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_NE(file("f.mtx").find("form factors that cannot reach 0.05 are left out, 0.0"),
            std::string::npos);
  EXPECT_GT(nlohmann::json::parse(file("f.json")).at("left_out_max").get<double>(), 0.02);
  const std::vector<std::string> from = {l_room, "--from", "f.mtx", "-o", "g.csv"};
  EXPECT_EQ(factors(from).exit_code, 0) << "what was left out is accounted for";
  EXPECT_EQ(factors(with(sparse, {"--enforce"})).exit_code, 0);
  EXPECT_NE(file("f.mtx").find("% scaled until rows, with space, sum to one"), std::string::npos);
  EXPECT_EQ(factors(from).exit_code, 0);
  const auto table = rows("g.csv");
  for (std::size_t i = 1; i < table.size(); ++i) {
    double sum = 0;
    for (std::size_t j = 2; j < table[i].size() - 2; ++j) sum += std::stod(table[i][j]);
    EXPECT_NEAR(sum, 1, 1e-12) << table[i][0];
  }
}

TEST_F(Factors, GoToTheStandardOutputAndKeepTheRestOffIt) {
  const test::Outcome outcome = factors({cube, "-o", "-", "--by", "material"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(outcome.out.starts_with("# halfshade"));
  EXPECT_EQ(outcome.out.find("pairs"), std::string::npos);
  EXPECT_NE(outcome.err.find("pairs"), std::string::npos);
}

TEST_F(Factors, ExamplesOfTheHelpRun) {
  fs::create_directory_symlink(scene_folder, folder_.path() / "data");
  const auto examples = test::examples_of(factors({"--help"}).out, "factors");
  EXPECT_GE(examples.size(), 3u);
  for (const std::vector<std::string>& arguments : examples) {
    const test::Outcome outcome = factors(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
  }
}

TEST_F(Factors, TellWhatIsSwallowedAndWhatIsNotReached) {
  const std::string s1 = (scene_folder / "s1.obj").string();
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
  const std::string dining_room = (scene_folder / "dining_room.obj").string();
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
