// `halfshade study` as a user runs it.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <gmock/gmock.h>
#include <map>
#include <sstream>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using Row = std::map<std::string, std::string>;

class StudyCommandTest : public testing::Test {
 protected:
  test::Outcome study(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {test::program, "study"});
    return test::run_program(std::move(arguments), folder_.path());
  }
  std::string file(const std::string& name) { return test::contents(folder_.path() / name); }
  bool exists(const std::string& name) { return fs::exists(folder_.path() / name); }

  std::vector<Row> rows(const std::string& name) {
    std::istringstream lines(file(name));
    std::string line, cell;
    std::vector<std::string> header;
    std::vector<Row> result;
    while (std::getline(lines, line)) {
      if (line.starts_with('#')) continue;
      std::vector<std::string> cells;
      std::istringstream stream(line + ",");
      while (std::getline(stream, cell, ',')) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), header.size()) << line;
      for (std::size_t k = 0; k < header.size() && k < cells.size(); ++k)
        (k == 0 ? result.emplace_back() : result.back())[header[k]] = cells[k];
    }
    return result;
  }

  /// Starts a study and ends it by a signal as soon as so many cases are done.
  test::Outcome ended(std::vector<std::string> arguments, int cases, int signal) {
    arguments.insert(arguments.begin(), {test::program, "study"});
    const pid_t child = test::start_program(std::move(arguments), folder_.path());
    const auto wanted = static_cast<std::size_t>(cases);
    for (int k = 0; k < 2000 && is_running(child); ++k) {
      if (wanted == 0 || (exists("out/study.csv") && rows("out/study.csv").size() >= wanted)) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * cases));
    kill(child, signal);
    return test::wait_for(child, folder_.path());
  }

  static bool is_running(pid_t child) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == 0;
  }

  test::TempDir folder_;
  const std::string s1_ = test::data_file("s1.obj").string();
  const std::string cornell_ = test::data_file("cornell_box.obj").string();
};

TEST_F(StudyCommandTest, MeasuresErrorsAndGoesOnWhereItWas) {
  const std::vector<std::string> all = {
      s1_,        "-o",     "out",    "--direct",  "--tolerances",
      "0.1,0.01", "--json", "r.json", "--methods", "fields,fields-no-curves,uniform,matrix"};
  const test::Outcome outcome = study(all);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto table = rows("out/study.csv");
  ASSERT_EQ(table.size(), 8u);
  for (const Row& row : table) {
    EXPECT_EQ(row.at("status"), "done");
    const double error = std::stod(row.at("error")), tolerance = std::stod(row.at("tolerance"));
    if (row.at("method").starts_with("fields")) {
      EXPECT_LT(error, tolerance);
    }
    EXPECT_LT(error, 0.2);
    EXPECT_EQ(row.at("direct_error"), row.at("error"));
    EXPECT_EQ(row.at("reflected_error"), "0");
    EXPECT_GT(std::stod(row.at("max_error")), error);
    EXPECT_GT(std::stod(row.at("seconds")), 0);
    EXPECT_GT(std::stod(row.at("process_seconds")), std::stod(row.at("seconds")));
    EXPECT_GT(std::stod(row.at("peak_memory_bytes")), 1e6);
    EXPECT_GT(std::stod(row.at("unknowns")), 10);
    EXPECT_NEAR(std::stod(row.at("effectivity")) * error, std::stod(row.at("estimated_error")),
                1e-12);
  }
  EXPECT_LT(std::stod(table[1].at("error")), std::stod(table[0].at("error")));
  for (const char* name : {"error_time.svg", "error_time.png", "estimated_true.png", "fields.png",
                           "matrix.png", "matrix_difference.png"})
    EXPECT_TRUE(exists(std::string("out/") + name)) << name;
  const std::string page = file("out/study.html");
  EXPECT_THAT(page, testing::HasSubstr("data:image/png;base64,iVBOR"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("src=\"http")));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_EQ(nlohmann::json::parse(file("r.json")).at("cases"), 8);

  const std::string before = file("out/study.csv");
  const test::Outcome again = study(all);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out.find("error"), std::string::npos) << "no case is run twice\n" << again.out;
  EXPECT_EQ(file("out/study.csv"), before);
  ASSERT_EQ(study({s1_, "-o", "out", "--direct", "--tolerances", "0.03", "--methods", "fields"})
                .exit_code,
            0);
  EXPECT_EQ(rows("out/study.csv").size(), 9u);
  test::expect_sentence(study({cornell_, "-o", "out", "--direct", "-q"}), 2, "another study");
  EXPECT_EQ(rows("out/study.csv").size(), 9u);
}

TEST_F(StudyCommandTest, LosesAndRepeatsNothingWhenInterruptedOrKilledAtTenMoments) {
  const std::vector<std::string> cases = {"--methods", "fields,uniform", "--tolerances",
                                          "0.3,0.1,0.05,0.03,0.02,0.01"};
  std::vector<std::string> arguments = {s1_, "-o", "whole", "--points", "50", "--direct", "-q"};
  arguments.insert(arguments.end(), cases.begin(), cases.end());
  ASSERT_EQ(study(arguments).exit_code, 0);
  arguments[2] = "out";
  std::string known;
  constexpr int moments = 10;
  for (int k = 0; k < moments; ++k) {
    // When k cases are done, and a little later each time: reading, the reference, in a case.
    const bool is_kill = k % 4 != 0;  // faster: without a page
    const test::Outcome outcome = ended(arguments, k, is_kill ? SIGKILL : SIGINT);
    if (!is_kill && k > 0) {  // at first it may not listen yet
      EXPECT_TRUE(outcome.exit_code == 130 || outcome.exit_code == 0) << outcome.err;
      if (outcome.exit_code == 130) {
        EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
      }
    }
    const std::string now = exists("out/study.csv") ? file("out/study.csv") : std::string();
    std::istringstream lines(known);
    for (std::string line; std::getline(lines, line);)
      EXPECT_NE(now.find(line), std::string::npos) << "lost or run again: " << line;
    known = now;
  }
  ASSERT_EQ(study(arguments).exit_code, 0);
  const auto whole = rows("whole/study.csv"), parts = rows("out/study.csv");
  ASSERT_EQ(whole.size(), 12u);
  ASSERT_EQ(parts.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k)
    for (const char* column : {"method", "tolerance", "status", "elements", "unknowns", "error",
                               "max_error", "estimated_error"})
      EXPECT_EQ(parts[k].at(column), whole[k].at(column)) << k << ' ' << column;
  EXPECT_TRUE(exists("out/study.html"));
}

TEST_F(StudyCommandTest, EndsWhatTakesTooLong) {
  const std::vector<std::string> all = {
      cornell_,    "-o",     "out",          "--points",  "20",           "--samples", "64",
      "--methods", "fields", "--tolerances", "1e-3,1e-4", "--time-limit", "0.5",       "-q"};
  ASSERT_EQ(study(all).exit_code, 0);
  const auto table = rows("out/study.csv");
  ASSERT_EQ(table.size(), 1u) << "finer ones are left out";
  EXPECT_EQ(table[0].at("status"), "time_limit");
  EXPECT_EQ(table[0].at("error"), "");
  EXPECT_GE(std::stod(table[0].at("process_seconds")), 0.5);
  EXPECT_TRUE(exists("out/study.html"));
}

TEST_F(StudyCommandTest, SaysInOneSentenceWhatIsWrong) {
  std::ofstream(folder_.path() / "dark.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(folder_.path() / "file") << "x";
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string names;
  } all[] = {
      {{s1_, "-o", "out", "--methods", "fields,guesswork"}, 2, "'guesswork' is none of fields"},
      {{s1_, "-o", "out", "--tolerances", "0.1,0"}, 2, "'0' is not a number above zero"},
      {{s1_, "-o", "out", "--tolerances", "0.1,x"}, 2, "'x'"},
      {{s1_, "-o", "out", "--time-limit", "0"}, 2, "'0'"},
      {{s1_}, 2, "--output"},
      {{"none.obj", "-o", "out"}, 3, "none.obj"},
      {{"dark.obj", "-o", "out"}, 3, "emit"},
      {{s1_, "-o", "file"}, 5, "file"},
      {{s1_, "-o", "/proc/none/out"}, 5, "/proc/none/out"},
      {{s1_, "-o", "out", "--json", "out/study.csv"}, 2, "out/study.csv"},
      {{s1_, "-o", "out", "--json", "out/any.svg"}, 2, "end in .json"},
  };
  for (const auto& wrong : all) {
    test::expect_sentence(study(wrong.arguments), wrong.exit_code, wrong.names);
    EXPECT_FALSE(exists("out"));
  }
}

TEST_F(StudyCommandTest, ExamplesOfTheHelpRun) {
  fs::create_directory_symlink(fs::path(test::data_folder), folder_.path() / "data");
  const auto examples = test::examples_of(study({"--help"}).out, "study");
  EXPECT_GE(examples.size(), 2u);
  for (auto arguments : examples) {
    arguments.insert(arguments.end(), {"--samples", "64"});
    const test::Outcome outcome = study(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
  }
}

}  // namespace
}  // namespace halfshade
