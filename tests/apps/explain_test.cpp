#include "io/picture/picture.h"
#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A cube whose faces look outwards, with a lamp inside.
void write_inside_out(const fs::path& folder) {
  std::ofstream(folder / "s.mtl") << "newmtl grey\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
  std::ofstream(folder / "s.obj")
      << "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
         "v .3 .3 .5\nv .6 .3 .5\nv .6 .6 .5\nv .3 .6 .5\nusemtl grey\ng body\nf 1 5 7 3\n"
         "f 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\nusemtl lamp\ng lamp\n"
         "f 9 12 11 10\n";
}

TEST(Explain, SaysWhatRunsAndWhatDoesNot) {
  const test::TempDir folder;
  const std::string s1 = (fs::path(test::data_folder) / "s1.obj").string();
  const test::Outcome outcome =
      test::run_halfshade({"explain", s1, "--json", "p.json"}, folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "left out     curves at three edges")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "--force eee"));
  EXPECT_TRUE(has(outcome.out, "runs         exact direct light"));
  nlohmann::json report;
  std::ifstream(folder.path() / "p.json") >> report;
  EXPECT_EQ(report["channels"], 1);
  EXPECT_EQ(report["sources"].size(), 1u);
  EXPECT_FALSE(report["parts"][0]["closed"]);
  const test::Outcome forced =
      test::run_halfshade({"explain", s1, "--force", "eee,channels"}, folder.path());
  EXPECT_TRUE(has(forced.out, "runs         curves at three edges"));
  EXPECT_TRUE(has(forced.out, "runs         second and third channel"));
  EXPECT_EQ(test::run_halfshade({"explain", s1, "--force", "nonsense"}, folder.path()).exit_code,
            2);
}

TEST(Explain, TakesAModelWithoutLight) {
  const test::TempDir folder;
  const fs::path file = folder.path() / "s.stl";
  std::ofstream(file) << "solid shell\n"
                         "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\n"
                         "vertex 1 0 0\nendloop\nendfacet\n"
                         "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                         "vertex 0 0 1\nendloop\nendfacet\n"
                         "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\n"
                         "vertex 0 1 0\nendloop\nendfacet\n"
                         "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\n"
                         "vertex 0 0 1\nendloop\nendfacet\nendsolid shell\n";
  const auto explained = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"explain", "s.stl", "--json", "p.json"};
    command.insert(command.end(), options.begin(), options.end());
    const test::Outcome outcome = test::run_halfshade(command, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  const std::string outwards = explained({}), inwards = explained({"--flip"});
  EXPECT_TRUE(has(outwards, "part         open: shell")) << outwards;
  EXPECT_TRUE(has(inwards, "part         closed: shell")) << inwards;
  EXPECT_TRUE(has(outwards, "left out     all light: no face emits any")) << outwards;
  nlohmann::json report;
  std::ifstream(folder.path() / "p.json") >> report;
  EXPECT_TRUE(report["sources"].empty());
  EXPECT_EQ(report["stages"].size(), 1u);
  EXPECT_EQ(test::run_halfshade({"solve", "s.stl", "-o", "s.vtu"}, folder.path()).exit_code, 3);
}

TEST(Explain, ListsNoMoreThanAFewRepairsUnlessAsked) {
  const test::TempDir folder;
  std::ofstream(folder.path() / "s.mtl") << "newmtl lamp\nKe 1 1 1\n";
  std::ofstream scene(folder.path() / "s.obj");
  scene << "mtllib s.mtl\nusemtl lamp\n";
  constexpr int squares = 8;  // of two triangles each
  for (int k = 0; k < squares; ++k)
    scene << "v 0 0 " << k << "\nv 1 0 " << k << "\nv 1 1 " << k << "\nv 0 1 " << k
          << "\nf -4 -3 -2\nf -4 -2 -1\n";
  scene.close();
  const auto joined = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"explain", "s.obj"};
    command.insert(command.end(), options.begin(), options.end());
    std::istringstream lines(test::run_halfshade(command, folder.path()).out);
    int told = 0, summed = 0;
    for (std::string line; std::getline(lines, line);) {
      if (has(line, "were joined")) ++told;
      if (has(line, "3 more like these (coplanar_merged)")) ++summed;
    }
    return std::pair(told, summed);
  };
  EXPECT_EQ(joined({}), std::pair(squares - 3, 1));
  EXPECT_EQ(joined({"--verbose"}), std::pair(squares, 0));
}

TEST(Explain, SpeaksOfBacksOnlyWhereLightCanReachThem) {
  const test::TempDir folder;
  const std::string mtl =
      "newmtl grey\nKd .5 .5 .5\nnewmtl lamp\nKd .5 .5 .5\nKe 1 1 1\nnewmtl black\nKd 0 0 0\n";
  const std::string facing =
      "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "usemtl lamp\ng light\nf 1 2 3 4\nusemtl grey\ng plate\nf 5 8 7 6\n";
  // Above, a black one that looks down; below, a wide one that looks up and reflects.
  const std::string beyond = "v 0 0 2\nv 1 0 2\nv 1 1 2\nusemtl black\ng above\nf 9 11 10\n";
  const std::string wide = "v -9 -9 -1\nv 9 -9 -1\nv 0 9 -1\ng wide\nf 9 10 11\n";
  std::ofstream(folder.path() / "s.mtl") << mtl;
  const auto said = [&](const std::string& text) {
    std::ofstream(folder.path() / "s.obj") << text;
    return test::run_halfshade({"explain", "s.obj"}, folder.path()).out;
  };
  EXPECT_FALSE(has(said(facing), "reaches the back")) << said(facing);
  EXPECT_FALSE(has(said(facing + beyond), "reaches the back")) << said(facing + beyond);
  EXPECT_TRUE(has(said(facing + wide), "reaches the back of light")) << said(facing + wide);
}

TEST(Explain, SaysHowReflectedLightWillBeFoundAndWhatItTakes) {
  const test::TempDir folder;
  const std::string box = (fs::path(test::data_folder) / "cornell_box.obj").string();
  const auto seconds = [&](const std::string& tolerance) {
    const test::Outcome outcome = test::run_halfshade(
        {"explain", box, "--tolerance", tolerance, "--json", "p.json"}, folder.path());
    EXPECT_TRUE(has(outcome.out, "reflected light, by exactly visible parts, ") &&
                has(outcome.out, " s or more"))
        << outcome.out;
    nlohmann::json report;
    std::ifstream(folder.path() / "p.json") >> report;
    for (const auto& stage : report["stages"])
      if (stage["name"] == "reflected light") return stage["seconds"].get<double>();
    return 0.;
  };
  EXPECT_GT(seconds("1e-2"), 0);
  EXPECT_GT(seconds("1e-3"), 2 * seconds("1e-2"));
  EXPECT_TRUE(
      has(test::run_halfshade({"explain", box, "--visibility", "sampled"}, folder.path()).out,
          "reflected light, by rays over hemispheres"));
}

TEST(Orientation, WhatLooksAwayFromTheLightIsToldAndCanBeTurned) {
  const test::TempDir folder;
  write_inside_out(folder.path());
  const auto solve = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"solve", "s.obj", "--elements", "200",
                                          "-o",    "o.vtu", "--json",     "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_halfshade(arguments, folder.path());
  };
  const test::Outcome outcome = solve({});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.err, "warning: no light reaches any surface")) << outcome.err;
  nlohmann::json report;
  std::ifstream(folder.path() / "r.json") >> report;
  EXPECT_EQ(report["warnings"][0]["kind"], "nothing_lit");
  for (const char* way : {"--flip", "--orient"}) {
    EXPECT_FALSE(has(solve({way}).err, "warning")) << way;
    std::ifstream(folder.path() / "r.json") >> report;
    EXPECT_TRUE(report["warnings"].empty());
    EXPECT_GT(report["groups"][0]["mean_irradiance_w_per_m2"][0], 0.01) << way;
  }
}

TEST(Reports, TellWhatWasReadAsTheTerminalDoes) {
  const test::TempDir folder;
  folder.write("s.mtl", "newmtl lamp\nKe 1 1 1\nmap_Ke missing.png\nnewmtl grey\n");
  folder.write("s.obj",
               "mtllib s.mtl\nv 0 0 2\nv 0 1 2\nv 1 0 2\nf 1 2 3\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv "
               "0 1 0\nf 4 5 6\n"
               "usemtl grey\nv 0 0 1\nv 0 1 1\nv 1 0 1\nf 7 8 9\n");
  for (const char* command : {"solve", "mesh", "explain"}) {
    const test::Outcome outcome =
        test::run_halfshade({command, "s.obj", "--json", "r.json"}, folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    nlohmann::json report;
    std::ifstream(folder.path() / "r.json") >> report;
    std::vector<std::string> kinds;
    for (const auto& warning : report["warnings"]) {
      EXPECT_TRUE(has(outcome.err, warning["sentence"].get<std::string>())) << outcome.err;
      kinds.push_back(warning["kind"]);
    }
    EXPECT_NE(std::ranges::find(kinds, "in_files"), kinds.end()) << command;
    EXPECT_NE(std::ranges::find(kinds, "guessed"), kinds.end()) << command;
  }
}

// A lamp of black and white texels close over the floor takes more pieces than there may be.
TEST(Reports, NameALampWithTooMuchDetailOnce) {
  const test::TempDir folder;
  Picture checks{16, 16, 1, {}, {}};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      checks.pixels.insert(checks.pixels.end(), 3, (x + y) % 2 == 0 ? 255 : 0);
  write_png(checks, folder.path() / "checks.png");
  folder.write("s.mtl",
               "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"
               "map_Ke checks.png\n");
  folder.write("s.obj",
               "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 .1\nv 0 1 .1\n"
               "v 1 1 .1\nv 1 0 .1\nvt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\nusemtl floor\n"
               "f 1 2 3 4\nusemtl lamp\nf 5/1 6/2 7/3 8/4\n");
  const test::Outcome outcome =
      test::run_halfshade({"solve", "s.obj", "--bounces", "0", "--json", "r.json"}, folder.path());
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  nlohmann::json report;
  std::ifstream(folder.path() / "r.json") >> report;
  ASSERT_EQ(report["warnings"].size(), 1u) << report["warnings"];
  EXPECT_EQ(report["warnings"][0]["kind"], "lamps_uneven");
  EXPECT_TRUE(has(outcome.err, report["warnings"][0]["sentence"].get<std::string>()));
}

}  // namespace
}  // namespace halfshade
