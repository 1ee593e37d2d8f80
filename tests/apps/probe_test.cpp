#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

class Probe : public testing::Test {
 protected:
  test::Outcome probe(std::vector<std::string> arguments,
                      std::chrono::milliseconds interrupt_after = {}) {
    arguments.insert(arguments.begin(), {test::program, "probe"});
    return test::run_program(std::move(arguments), folder_.path(), interrupt_after);
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  std::string file(const std::string& name) { return test::contents(folder_.path() / name); }
  bool exists(const std::string& name) { return fs::exists(folder_.path() / name); }
  const fs::path& folder() const { return folder_.path(); }

  /// The numbers of a table below its header.
  std::vector<std::vector<double>> numbers(const std::string& name) {
    std::istringstream lines(file(name));
    std::vector<std::vector<double>> rows;
    std::string line;
    do {
      std::getline(lines, line);
    } while (line.starts_with('#'));
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');)
        rows.back().push_back(std::stod(cell));
    }
    return rows;
  }

 private:
  test::TempDir folder_;
};

const std::string s1 = test::data_file("s1.obj").string();
const std::string s1_points = test::data_file("s1_points.csv").string();

TEST_F(Probe, GivesTheKnownValuesOfS1) {
  const test::Outcome outcome = probe({s1, "--points", s1_points, "-o", "o.csv", "--direct"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(file("o.csv").substr(0, 38), "x,y,z,nx,ny,nz,H_r,H_g,H_b,visible\n0,0");
  const auto rows = numbers("o.csv");
  ASSERT_EQ(rows.size(), 7u);
  constexpr double want[6] = {0, 0, 0.018916915317, 0.033762803811, 0.040681704379, 0.032271304623};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(rows[k][6], want[k], 1e-12);
    EXPECT_EQ(rows[k][6], rows[k][7]);
    EXPECT_EQ(rows[k][6], rows[k][8]);
  }
  EXPECT_EQ(rows[0][9], 0) << "umbra";
  EXPECT_GT(rows[2][9], 0);
  EXPECT_LT(rows[2][9], 1);
  EXPECT_EQ(rows[5][9], 1) << "lit";
}

TEST_F(Probe, PutsAGridOnAGroup) {
  ASSERT_EQ(probe({s1, "--grid", "receiver", "--spacing", "0.5", "-o", "o.csv", "--direct", "-q"})
                .exit_code,
            0);
  const auto rows = numbers("o.csv");
  EXPECT_EQ(rows.size(), 49u) << "3.7984 / 0.5 = 7 squares a side";
  for (const auto& row : rows) {
    EXPECT_LT(std::abs(row[0] + 0.0379), 1.8992);
    EXPECT_EQ(row[2], 0);
    EXPECT_EQ(row[5], 1);
    const double far = std::max(std::abs(row[0]), std::abs(row[1]));
    EXPECT_EQ(row[9] == 0, far < 0.25);
    EXPECT_EQ(row[9] == 1, far > 1.25);
  }
  ASSERT_EQ(probe({s1, "--grid", "receiver", "--spacing", "0.5", "-o", "o.vtp", "--direct", "-q"})
                .exit_code,
            0);
  EXPECT_NE(file("o.vtp").find("NumberOfPoints=\"49\""), std::string::npos);
}

TEST_F(Probe, AddsInterreflectionUnlessToldNotTo) {
  // White furnace: E = 1 − rho on every wall makes B = 1 everywhere, hence H = 1.
  write("p.csv", "0.3,0.4,0.5,0,0,1\n0.5,0.2,0.7,1,0,0\n0.1,0.9,0.5,0.6,0,-0.8\n");
  const std::string cube = test::data_file("furnace_cube.obj").string();
  ASSERT_EQ(probe({cube, "--points", "p.csv", "-o", "all.csv"}).exit_code, 0);
  ASSERT_EQ(probe({cube, "--points", "p.csv", "-o", "direct.csv", "--direct"}).exit_code, 0);
  const auto all = numbers("all.csv"), direct = numbers("direct.csv");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(all[k][6], 1, 1e-6);
    EXPECT_LT(direct[k][6], 0.9);
  }
}

TEST_F(Probe, TracesRandomWalksAsAReference) {
  ASSERT_EQ(probe({s1, "--points", s1_points, "-o", "o.csv", "--method", "reference", "--samples",
                   "16384", "--json", "r.json"})
                .exit_code,
            0);
  EXPECT_EQ(file("o.csv").substr(0, 74),
            "x,y,z,nx,ny,nz,H_r,H_g,H_b,H_r_error,H_g_error,H_b_error,D_r,D_g,D_b,D_r_e");
  constexpr double want[6] = {0, 0, 0.018916915317, 0.033762803811, 0.040681704379, 0.032271304623};
  const auto rows = numbers("o.csv");
  ASSERT_EQ(rows.size(), 7u);
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_EQ(rows[k].size(), 18u);
    EXPECT_NEAR(rows[k][6], want[k], 4 * rows[k][9]);
    EXPECT_LE(rows[k][9], 5e-3 * want[k]);
    EXPECT_EQ(rows[k][12], rows[k][6]) << "nothing comes back";
  }
  ASSERT_EQ(probe({s1, "--grid", "receiver", "--spacing", "0.1", "-o", "one.csv", "--method",
                   "reference", "--samples", "64", "--threads", "1"})
                .exit_code,
            0);
  ASSERT_EQ(probe({s1, "--grid", "receiver", "--spacing", "0.1", "-o", "two.csv", "--method",
                   "reference", "--samples", "64", "--threads", "2"})
                .exit_code,
            0);
  EXPECT_EQ(file("one.csv"), file("two.csv"));
}

TEST_F(Probe, ReportsAsJsonAndKeepsQuiet) {
  const test::Outcome outcome =
      probe({s1, "--points", s1_points, "-o", "o.csv", "--direct", "-q", "--json", "r.json"});
  EXPECT_EQ(outcome.out + outcome.err, "");
  const auto report = nlohmann::json::parse(file("r.json"));
  EXPECT_EQ(report.at("points"), 7);
  EXPECT_EQ(report.at("points_done"), 7);
  EXPECT_EQ(report.at("interrupted"), false);
  EXPECT_EQ(report.at("direct_only"), true);
}

TEST_F(Probe, ThreadsDoNotChangeTheBytes) {
  const auto bytes = [&](const std::string& threads) {
    EXPECT_EQ(probe({test::data_file("bars.obj").string(), "--grid", "floor", "--spacing", "0.2",
                     "-o", "o.csv", "--direct", "-q", "--threads", threads})
                  .exit_code,
              0);
    return file("o.csv");
  };
  EXPECT_EQ(bytes("1"), bytes("2"));
}

TEST_F(Probe, WritesWhatIsDoneWhenInterrupted) {
  test::Outcome outcome;
  // A busy machine may need longer before there is something to write.
  for (int ms = 1500; ms <= 12000 && !exists("r.json"); ms *= 2)
    outcome = probe({test::data_file("hundred_lights.obj").string(), "--grid", "floor", "--spacing",
                     "0.01", "-o", "o.csv", "--direct", "--json", "r.json"},
                    std::chrono::milliseconds(ms));
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("interrupted: "), std::string::npos) << outcome.err;
  const auto report = nlohmann::json::parse(file("r.json"));
  EXPECT_EQ(report.at("interrupted"), true);
  EXPECT_EQ(report.at("status"), "interrupted");
  EXPECT_EQ(report.at("points_done"), numbers("o.csv").size());
  EXPECT_EQ(file("o.csv").substr(0, 15), "# interrupted: ");
}

TEST_F(Probe, ExamplesOfTheHelpRun) {
  fs::create_directory_symlink(test::data_folder, folder() / "data");
  const auto examples = test::examples_of(probe({"--help"}).out, "probe");
  EXPECT_GE(examples.size(), 3u);
  for (const std::vector<std::string>& arguments : examples) {
    const test::Outcome outcome = probe(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
  }
  for (const char* name : {"s1.csv", "bars.vtp", "cornell.csv", "walks.csv"})
    EXPECT_TRUE(exists(name)) << name;
}

TEST_F(Probe, SaysInOneSentenceWhatIsWrong) {
  write("bad.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,3,0,0,0\n");
  write("nan.csv", "x,y,z,nx,ny,nz\n1,nan,3,0,0,1\n");
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string names;
  };
  const std::vector<Wrong> all = {
      {{s1, "--points", "none.csv", "-o", "o.csv"}, 3, "none.csv"},
      {{s1, "--points", "bad.csv", "-o", "o.csv"}, 3, "bad.csv:3"},
      {{s1, "--points", "nan.csv", "-o", "o.csv"}, 3, "nan.csv:2"},
      {{"none.obj", "--points", s1_points, "-o", "o.csv"}, 3, "none.obj"},
      {{"dark.obj", "--points", s1_points, "-o", "o.csv"}, 3, "emit"},
      {{s1, "--points", s1_points, "-o", "o.txt"}, 2, ".txt"},
      {{s1, "--points", s1_points, "-o", "none/o.csv"}, 5, "none"},
      {{s1, "--grid", "ceiling", "--spacing", "1", "-o", "o.csv"}, 2, "ceiling"},
      {{s1, "--grid", "receiver", "--spacing", "1e-9", "-o", "o.csv"}, 3, "1e-09"},
  };
  for (const Wrong& wrong : all) {
    test::expect_sentence(probe(wrong.arguments), wrong.exit_code, wrong.names);
    EXPECT_FALSE(exists("o.csv"));
  }
}

TEST_F(Probe, RefusesContradictoryUsage) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{s1, "-o", "o.csv"},
        {s1, "--points", s1_points},
        {s1, "--grid", "receiver", "-o", "o.csv"},
        {s1, "--spacing", "1", "--points", s1_points, "-o", "o.csv"},
        {s1, "--grid", "receiver", "--spacing", "1", "--points", s1_points, "-o", "o.csv"},
        {s1, "--grid", "receiver", "--spacing", "0", "-o", "o.csv"}}) {
    EXPECT_EQ(probe(arguments).exit_code, 2);
    EXPECT_FALSE(exists("o.csv"));
  }
}

// What is gathered from a file is what is gathered from a solution made on the way, but for their
// errors: of both, and of the rays.
TEST_F(Probe, GathersFromAResultOfSolve) {
  const std::string box = test::data_file("cornell_box.obj").string();
  for (const char* name : {"box.vtu", "box.vtp"}) {
    const test::Outcome solved = test::run_program(
        {test::program, "solve", box, "--tolerance", "0.02", "-o", name, "-q"}, folder());
    ASSERT_EQ(solved.exit_code, 0) << solved.err;
    const std::vector<std::string> at = {box,  "--grid",      "floor", "--spacing",
                                         "60", "--tolerance", "0.02"};
    std::vector<std::string> read = at, made = at;
    read.insert(read.end(), {"--solution", name, "-o", "read.csv"});
    made.insert(made.end(), {"-o", "made.csv"});
    ASSERT_EQ(probe(read).exit_code, 0);
    ASSERT_EQ(probe(made).exit_code, 0);
    const auto of_file = numbers("read.csv"), of_solution = numbers("made.csv");
    ASSERT_EQ(of_file.size(), of_solution.size());
    ASSERT_GT(of_file.size(), 50u);
    double off = 0, all = 0;
    for (std::size_t k = 0; k < of_file.size(); ++k)
      for (std::size_t c = 6; c < 9; ++c) {  // x, y, z, nx, ny, nz, H
        off += std::pow(of_file[k][c] - of_solution[k][c], 2);
        all += std::pow(of_solution[k][c], 2);
      }
    EXPECT_LT(std::sqrt(off / all), 0.02) << name;
    EXPECT_GT(off, 0) << "it is not solved for again";
  }
}

// What a file says of itself is not lost.
TEST_F(Probe, ASolutionThatIsLessThanAskedForIsNotTakenForMore) {
  const std::string box = test::data_file("cornell_box.obj").string();
  const auto solve = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {test::program, "solve", box, "--tolerance", "0.05", "-q", "-o", "box.vtu"});
    return test::run_program(more, folder()).exit_code;
  };
  const auto gather = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {box, "--grid", "floor", "--spacing", "200", "--solution", "box.vtu",
                               "-o", "o.csv"});
    return probe(more);
  };
  ASSERT_EQ(solve({}), 0);
  EXPECT_EQ(gather({}).exit_code, 0);
  const test::Outcome finer = gather({"--tolerance", "0.001"});
  EXPECT_EQ(finer.exit_code, 4);
  EXPECT_NE(finer.err.find("instead of 0.001"), std::string::npos) << finer.err;
  ASSERT_EQ(solve({"--bounces", "1"}), 0);
  const test::Outcome once = gather({});
  EXPECT_EQ(once.exit_code, 3);
  EXPECT_NE(once.err.find("reflected 1 times at most"), std::string::npos) << once.err;
}

TEST_F(Probe, ASolutionOfAnotherSceneIsRefused) {
  const test::Outcome solved =
      test::run_program({test::program, "solve", test::data_file("l_room.obj").string(),
                         "--tolerance", "0.1", "-o", "l.vtu", "-q"},
                        folder());
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const test::Outcome outcome =
      probe({s1, "--points", s1_points, "--solution", "l.vtu", "-o", "o.csv"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("l.vtu: this is no solution of the scene"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(exists("o.csv"));
  EXPECT_EQ(probe({s1, "--points", s1_points, "--solution", s1, "-o", "o.csv"}).exit_code, 3);
  EXPECT_EQ(probe({s1, "--points", s1_points, "--solution", "none.vtu", "-o", "o.csv"}).exit_code,
            3);
  EXPECT_EQ(probe({s1, "--points", s1_points, "--solution", "l.vtu", "--direct", "-o", "o.csv"})
                .exit_code,
            2);
  EXPECT_EQ(probe({s1, "--points", s1_points, "--solution", "l.vtu", "-o", "l.vtu"}).exit_code, 2);
}

}  // namespace
}  // namespace halfshade
