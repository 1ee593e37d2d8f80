// A run that is killed at any moment leaves no damaged file, and none that is partial and does not
// say so. The moments are random but the same in every run of the test; their number is
// HALFSHADE_KILLS (6 if it is not set). The long run:
//   HALFSHADE_KILLS=50 build/release/tests/apps_tests --gtest_filter='*KilledAtAnyMoment*'

#include "io/files/seal.h"
#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Command {
  std::string name;
  std::vector<std::string> arguments;  ///< "DATA/" stands for the folder of scenes
  std::vector<std::string> outputs;    ///< besides report.json
};

void PrintTo(const Command& command, std::ostream* out) { *out << command.name; }

std::vector<std::string> command_line(const Command& command) {
  std::vector<std::string> line = {test::program, command.name};
  for (const std::string& argument : command.arguments)
    line.push_back(argument.starts_with("DATA/") ? test::data_file(argument.substr(5)).string()
                                                 : argument);
  line.insert(line.end(), {"--json", "report.json"});
  return line;
}

/// What stands in a VTK file between the tags of its field "interrupted".
std::string interrupted_field(const std::string& vtk) {
  const std::size_t name = vtk.find("Name=\"interrupted\"");
  return name == vtk.npos ? "" : vtk.substr(name, vtk.find("</DataArray>", name) - name);
}

/// Whether a file that is neither old nor complete says that it is partial, and is not damaged.
bool is_marked(const std::string& name, const std::string& bytes, const std::string& complete) {
  const std::string extension = fs::path(name).extension();
  if (extension == ".csv") return bytes.starts_with("# interrupted: ") && bytes.ends_with("\n");
  if (extension == ".ply")
    return bytes.substr(0, bytes.find("end_header")).find("comment interrupted") != bytes.npos;
  if (extension == ".png")
    return bytes.find("interrupted") != bytes.npos && bytes.find("IEND") == bytes.size() - 8;
  return detail::is_sealed(bytes) && interrupted_field(bytes) != interrupted_field(complete);
}

class KilledAtAnyMoment : public testing::TestWithParam<Command> {
 protected:
  void SetUp() override {
    const auto start = Clock::now();
    const test::TempDir folder;
    ASSERT_EQ(test::run_program(command_line(GetParam()), folder.path()).exit_code, 0);
    duration_ = Clock::now() - start;
    for (const std::string& name : GetParam().outputs)
      complete_[name] = test::contents(folder.path() / name);
  }

  void kill_once(int signal, double share) {
    const test::TempDir folder;
    for (const std::string& name : GetParam().outputs) folder.write(name, "old");
    folder.write("report.json", "old");
    const pid_t child = test::start_program(command_line(GetParam()), folder.path());
    std::this_thread::sleep_for(share * duration_);
    kill(child, signal);
    const test::Outcome outcome = test::wait_for(child, folder.path());
    const std::string when =
        fmt::format("signal {} after {:.3f} of the run: {}", signal, share, outcome.err);
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 130 || outcome.exit_code == -1)
        << when;
    expect_whole_files(folder.path(), outcome, when);
    if (outcome.exit_code >= 0) expect_nothing_left_over(folder.path(), when);
  }

  std::chrono::duration<double> duration_{};
  std::map<std::string, std::string> complete_;

 private:
  void expect_whole_files(const fs::path& folder, const test::Outcome& outcome,
                          const std::string& when) const {
    for (const auto& [name, complete] : complete_) {
      const std::string bytes = test::contents(folder / name);
      if (bytes == "old" || bytes == complete) continue;
      EXPECT_EQ(outcome.exit_code, 130) << name << ": " << when;
      EXPECT_TRUE(is_marked(name, bytes, complete)) << name << ": " << when;
    }
    const std::string report = test::contents(folder / "report.json");
    if (report == "old") return;
    const auto json = nlohmann::json::parse(report, nullptr, false);
    ASSERT_TRUE(json.is_object()) << when;
    if (outcome.exit_code < 0) return;
    EXPECT_EQ(json.at("status"), outcome.exit_code == 0 ? "done" : "interrupted") << when;
  }

  static void expect_nothing_left_over(const fs::path& folder, const std::string& when) {
    for (const auto& entry : fs::directory_iterator(folder))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".halfshade")) << when;
  }
};

TEST_P(KilledAtAnyMoment, LeavesOldWholeOrMarkedFiles) {
  const char* asked = std::getenv("HALFSHADE_KILLS");
  const int count = asked != nullptr ? std::atoi(asked) : 6;
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0, 1.05);
  for (const int signal : {SIGKILL, SIGINT, SIGTERM})
    for (int k = 0; k < count; ++k) kill_once(signal, share(random));
}

INSTANTIATE_TEST_SUITE_P(
    Commands, KilledAtAnyMoment,
    testing::Values(
        Command{"solve",
                {"DATA/l_room.obj", "--elements", "600", "-q", "-o", "a.vtu", "-o", "a.ply"},
                {"a.vtu", "a.ply"}},
        Command{"mesh",
                {"DATA/skew_bars.obj", "-q", "-o", "a.vtu", "-o", "a.ply", "--curves", "c.vtp",
                 "--picture", "a.png", "--pixels", "150"},
                {"a.vtu", "a.ply", "c.vtp", "a.png"}},
        Command{"probe",
                {"DATA/bars.obj", "--grid", "floor", "--spacing", "0.03", "--direct", "-q", "-o",
                 "a.csv"},
                {"a.csv"}},
        Command{"render",
                {"DATA/dining_room.obj", "-q", "-o", "a.png", "--width", "200", "--height", "150"},
                {"a.png"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace halfshade
