#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

const fs::path data = test::data_folder;

void write_file(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string lamp = "mtllib lamp.mtl\nusemtl lamp\n" + square + "f 1 2 3 4\n";
const std::string lamp_material = "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n";

struct BadInput {
  std::string name;
  std::string scene;     ///< the .obj; "-": none is written
  std::string material;  ///< lamp.mtl
  std::vector<std::string> arguments;
  int exit_code;
  std::string sentence_names;  ///< what the message must contain
};

void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

class BadInputs : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, GiveOneSentenceAndTheDocumentedExitCode) {
  const BadInput& input = GetParam();
  const test::TempDir folder;
  if (input.scene != "-") write_file(folder.path() / "scene.obj", input.scene);
  write_file(folder.path() / "lamp.mtl", input.material);
  const test::Outcome outcome = test::run_halfshade(input.arguments, folder.path());
  test::expect_sentence(outcome, input.exit_code, input.sentence_names);
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().extension() == ".vtu" || entry.path().extension() == ".ply", false)
        << entry.path();
}

const std::vector<std::string> solve_scene = {"solve", "scene.obj", "-o", "out.vtu"};

INSTANTIATE_TEST_SUITE_P(
    Solve, BadInputs,
    testing::Values(
        BadInput{"missing_file", "-", "", solve_scene, 3, "scene.obj"},
        BadInput{"folder_as_scene", "-", "", {"solve", ".", "-o", "out.vtu"}, 2, "."},
        BadInput{"empty_file", "", "", solve_scene, 3, "scene.obj"},
        BadInput{"truncated", square + "f 1 2", "", solve_scene, 3, "scene.obj:5"},
        BadInput{"truncated_number", "v 0 0 0\nv 1 0", "", solve_scene, 3, "scene.obj:2"},
        BadInput{"nan", "v nan 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "", solve_scene, 3, "scene.obj"},
        BadInput{"infinite", "v 1e999 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "", solve_scene, 3,
                 "scene.obj"},
        BadInput{"index_out_of_range", square + "f 1 2 9\n", "", solve_scene, 3, "9"},
        BadInput{"index_zero", square + "f 0 1 2\n", "", solve_scene, 3, "0"},
        BadInput{"reflectance_above_one", lamp, "newmtl lamp\nKd 1.2 0 0\nKe 1 1 1\n", solve_scene,
                 3, "1.2"},
        BadInput{"negative_exitance", lamp, "newmtl lamp\nKd 0 0 0\nKe 1 -3 1\n", solve_scene, 3,
                 "-3"},
        BadInput{"missing_material_library", "mtllib none.mtl\n" + lamp, lamp_material, solve_scene,
                 3, "none.mtl"},
        BadInput{"no_faces", square, "", solve_scene, 3, "face"},
        BadInput{"no_emitter", square + "f 1 2 3 4\n", "", solve_scene, 3, "emit"},
        BadInput{"zero_area_only",
                 "mtllib lamp.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
                 lamp_material, solve_scene, 3, "area"},
        BadInput{"one_point_only", "mtllib lamp.mtl\nusemtl lamp\nv 5 5 5\nf 1 1 1\n",
                 lamp_material, solve_scene, 3, "scene.obj"},
        BadInput{
            "unknown_scene_extension", "-", "", {"solve", "scene.xyz", "-o", "out.vtu"}, 2, ".xyz"},
        BadInput{"unknown_output_extension",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "-o", "out.doc"},
                 2,
                 ".doc"},
        BadInput{"output_folder_missing",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "-o", "none/out.vtu"},
                 5,
                 "none"},
        BadInput{"output_below_a_file",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "-q", "-o", "lamp.mtl/out.vtu"},
                 5,
                 "lamp.mtl"},
        BadInput{"output_device_full",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "-q", "--json", "/proc/none.json", "-o", "out.png"},
                 5,
                 "/proc"},
        BadInput{"missing_materials_file",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "--materials", "none.json", "-o", "out.vtu"},
                 3,
                 "none.json"},
        BadInput{"too_many_elements",
                 lamp,
                 lamp_material,
                 {"solve", "scene.obj", "--max-length", "0.001", "-o", "out.vtu"},
                 3,
                 "elements"},
        BadInput{"render_missing", "-", "", {"render", "none.vtu", "-o", "out.png"}, 3, "none.vtu"},
        BadInput{"render_to_unknown",
                 lamp,
                 lamp_material,
                 {"render", "scene.obj", "-o", "out.gif"},
                 2,
                 ".gif"},
        BadInput{"render_unknown_camera",
                 lamp,
                 lamp_material,
                 {"render", "scene.obj", "--camera", "nobody", "-o", "out.png"},
                 2,
                 "nobody"}),
    [](const auto& info) { return info.param.name; });

TEST(CommandLine, AFaceThatCrossesItselfIsSplitAndNamed) {
  const test::TempDir folder;
  write_file(folder.path() / "lamp.mtl", lamp_material);
  // One half of the bow tie looks at the point below: as much light as from a triangle in its
  // place.
  write_file(folder.path() / "tie.obj", "mtllib lamp.mtl\nusemtl lamp\n" + square + "f 1 3 2 4\n");
  write_file(folder.path() / "half.obj",
             "mtllib lamp.mtl\nusemtl lamp\n" + square + "v .5 .5 0\nf 5 3 2\n");
  write_file(folder.path() / "p.csv", "x,y,z,nx,ny,nz\n.3,.4,-1,0,0,1\n");
  std::vector<std::string> light;
  for (const std::string name : {"tie", "half"}) {
    const test::Outcome outcome = test::run_halfshade(
        {"probe", name + ".obj", "--points", "p.csv", "--direct", "-o", name + ".csv"},
        folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("face 1 ") != std::string::npos &&
                  outcome.err.find("crosses itself") != std::string::npos,
              name == "tie")
        << outcome.err;
    light.push_back(test::contents(folder.path() / (name + ".csv")));
  }
  EXPECT_EQ(light[0], light[1]);
}

TEST(CommandLine, WrongUsageEndsWithCode2AndSaysHowToGetHelp) {
  const test::TempDir folder;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"bake"},
                                                    {"solve"},
                                                    {"solve", "a.obj", "--elements", "few"},
                                                    {"solve", "a.obj", "--elements", "0"},
                                                    {"solve", "a.obj", "--nonsense"},
                                                    {"render", "a.vtu"}}) {
    const test::Outcome outcome = test::run_halfshade(arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("--help"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(test::run_halfshade({"--help"}, folder.path()).exit_code, 0);
  EXPECT_EQ(test::run_halfshade({"solve", "--help"}, folder.path()).exit_code, 0);
  EXPECT_EQ(test::run_halfshade({"--version"}, folder.path()).exit_code, 0);
}

TEST(CommandLine, ExamplesOfTheHelpRun) {
  const test::TempDir folder;
  fs::create_directory_symlink(data, folder.path() / "data");
  // What the examples of render start from.
  ASSERT_EQ(test::run_halfshade({"solve", "data/s1.obj", "--elements", "100", "-q"}, folder.path())
                .exit_code,
            0);
  int ran = 0;
  for (const std::string command : {"solve", "render"})
    for (auto arguments :
         test::examples_of(test::run_halfshade({command, "--help"}, folder.path()).out, command)) {
      arguments.insert(arguments.begin(), command);
      const auto has = [&](const char* option) {
        return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
      };
      if (command == "solve" && !has("--elements") && !has("--tolerance"))
        arguments.insert(arguments.end(), {"--elements", "300"});
      const test::Outcome outcome = test::run_halfshade(arguments, folder.path());
      EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
      ++ran;
    }
  EXPECT_GE(ran, 6);
  for (const char* file : {"cornell.vtu", "cornell.ply", "cornell.png", "l_room.vtu", "s1.png"})
    EXPECT_TRUE(fs::exists(folder.path() / file)) << file;
}

TEST(CommandLine, ElementsAskedForThatAreTooFewForAToleranceAskedFor) {
  const test::TempDir folder;
  const std::string s1 = (data / "s1.obj").string();
  for (const std::string more : {"", "--refine=uniform", "--method=matrix"}) {
    std::vector<std::string> words = {"solve", s1, "-q", "--elements", "50", "--tolerance", "1e-5"};
    if (!more.empty()) words.push_back(more);
    const test::Outcome outcome = test::run_halfshade(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_NE(outcome.err.find("with these elements the error is about"), std::string::npos)
        << outcome.err;
  }
  EXPECT_EQ(test::run_halfshade({"solve", s1, "--elements", "50"}, folder.path()).exit_code, 0);
}

TEST(CommandLine, QuietIsQuietAndJsonTellsAll) {
  const test::TempDir folder;
  const test::Outcome outcome =
      test::run_halfshade({"solve", (data / "s1.obj").string(), "--elements", "200", "-q", "-o",
                           "out.ply", "--json", "report.json"},
                          folder.path());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  const auto report = nlohmann::json::parse(test::contents(folder.path() / "report.json"));
  EXPECT_GT(report.at("mesh").at("elements").get<int>(), 100);
  EXPECT_FALSE(report.at("interrupted").get<bool>());
  const test::Outcome talk = test::run_halfshade(
      {"solve", (data / "s1.obj").string(), "--elements", "200", "-o", "out.ply"}, folder.path());
  EXPECT_NE(talk.out.find("out.ply"), std::string::npos);
  EXPECT_EQ(talk.err, "") << "no progress bar without a terminal";
}

TEST(CommandLine, ThreadsDoNotChangeTheBytes) {
  const test::TempDir folder;
  const auto body = [&](const std::string& threads) {
    EXPECT_EQ(test::run_halfshade({"solve", (data / "l_room.obj").string(), "--elements", "500",
                                   "-q", "--threads", threads, "-o", "out.ply"},
                                  folder.path())
                  .exit_code,
              0);
    const std::string text = test::contents(folder.path() / "out.ply");
    return text.substr(text.find("end_header"));
  };
  EXPECT_EQ(body("1"), body("2"));
}

TEST(CommandLine, InterruptWritesAMarkedPartialResult) {
  const test::TempDir folder;
  const test::Outcome outcome = test::run_halfshade(
      {"solve", (data / "cornell_box.obj").string(), "--method", "matrix", "--elements", "20000",
       "-o", "out.vtu", "-o", "marked.png", "--json", "report.json"},
      folder.path(), std::chrono::milliseconds(1500));
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(folder.path() / "out.vtu"));
  EXPECT_NE(test::contents(folder.path() / "marked.png").find("interrupted: "), std::string::npos);
  const auto report = nlohmann::json::parse(test::contents(folder.path() / "report.json"));
  EXPECT_TRUE(report.at("interrupted").get<bool>());
  EXPECT_EQ(test::run_halfshade({"render", "out.vtu", "-o", "out.png", "--samples", "1", "-q"},
                                folder.path())
                .exit_code,
            0);
}

}  // namespace
}  // namespace halfshade
