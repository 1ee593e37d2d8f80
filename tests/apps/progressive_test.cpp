// `halfshade solve --progressive` as a user runs it.

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

class ProgressiveSeries : public testing::Test {
 protected:
  test::Outcome solve(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {test::program, "solve", room_, "-q"});
    return test::run_program(std::move(arguments), folder_.path());
  }
  /// With the method that shoots.
  test::Outcome shoot(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"--method", "matrix",   "--elements",
                                          "150",      "--solver", "southwell-ambient"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return solve(arguments);
  }
  /// The files that an index names, with their times.
  std::vector<std::pair<double, std::string>> series(const std::string& index) {
    std::istringstream lines(test::contents(folder_.path() / index));
    std::vector<std::pair<double, std::string>> found;
    const auto quoted = [](const std::string& line, const std::string& name) {
      const std::size_t begin = line.find(name + "=\"") + name.size() + 2;
      return line.substr(begin, line.find('"', begin) - begin);
    };
    for (std::string line; std::getline(lines, line);)
      if (line.find("<DataSet") != std::string::npos)
        found.emplace_back(std::stod(quoted(line, "timestep")), quoted(line, "file"));
    return found;
  }

  test::TempDir folder_;
  const std::string room_ = test::data_file("l_room.obj").string();
};

TEST_F(ProgressiveSeries, NamesWholeFilesAndItsPowerIsSomewhere) {
  const test::Outcome outcome = shoot({"--progressive", "a/stages", "--json", "r.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto files = series("a/stages/progressive.pvd");
  const auto report = nlohmann::json::parse(test::contents(folder_.path() / "r.json"));
  const auto& stages = report.at("radiosity").at("stages");
  const auto& channels = report.at("radiosity").at("channel");
  ASSERT_EQ(files.size(), stages.size());
  EXPECT_GT(files.size(), 8u);
  EXPECT_LT(files.size(), 60u);
  for (std::size_t k = 0; k < files.size(); ++k) {
    EXPECT_TRUE(fs::exists(folder_.path() / "a/stages" / files[k].second));
    EXPECT_EQ(files[k].first, stages[k].at("shots").get<double>());
    EXPECT_TRUE(k == 0 || files[k].first > files[k - 1].first);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double emitted = channels[c].at("emitted_power");
      const auto power = [&](const char* name) { return stages[k].at(name)[c].get<double>(); };
      EXPECT_NEAR(power("unshot_power") + power("absorbed_power") + power("escaped_power"), emitted,
                  1e-9 * emitted);
    }
  }
  EXPECT_EQ(report.at("outputs").back(), "a/stages/progressive.pvd");
  EXPECT_FALSE(fs::exists(folder_.path() / "l_room.vtu")) << "nobody asked for it";
}

TEST_F(ProgressiveSeries, ReplacesALongerOne) {
  ASSERT_EQ(shoot({"--progressive", "out"}).exit_code, 0);
  const std::size_t count = series("out/progressive.pvd").size();
  std::ofstream(folder_.path() / "out" / ("stage_0" + std::to_string(count) + ".vtu")) << "old";
  std::ofstream(folder_.path() / "out" / "mine.txt") << "kept";
  ASSERT_EQ(shoot({"--progressive", "out"}).exit_code, 0);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_.path() / "out")) ++files;
  EXPECT_EQ(files, count + 2) << "stages, index and what is not of a series";
}

TEST_F(ProgressiveSeries, IsRefusedInOneSentence) {
  std::ofstream(folder_.path() / "file") << "x";
  const std::string needs = "stages are of shooting";
  test::expect_sentence(solve({"--progressive", "s"}), 2, needs);
  test::expect_sentence(solve({"--method", "matrix", "--progressive", "s"}), 2, needs);
  test::expect_sentence(solve({"--solver", "southwell", "--progressive", "s"}), 2, needs);
  test::expect_sentence(shoot({"--bounces", "1", "--progressive", "s"}), 2, needs);
  test::expect_sentence(shoot({"--subdivide", "1", "--progressive", "s"}), 2, needs);
  test::expect_sentence(shoot({"--progressive", "s", "-o", "s/stage_000.vtu"}), 5, "s");
  fs::create_directory(folder_.path() / "s");
  test::expect_sentence(shoot({"--progressive", "s", "-o", "s/stage_000.vtu"}), 2, "another name");
  test::expect_sentence(shoot({"--progressive", "s", "--json", "s/progressive.pvd"}), 2,
                        "another name");
  test::expect_sentence(shoot({"--progressive", "file"}), 5, "file");
  test::expect_sentence(shoot({"--progressive", "/proc/none/s"}), 5, "/proc");
}

}  // namespace
}  // namespace halfshade
