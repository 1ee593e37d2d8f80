// What the program says to a clumsy command line, and what comes in and goes out by streams.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace halfshade {
namespace {

using Arguments = std::vector<std::string>;

class Usage : public testing::Test {
 protected:
  test::Outcome run(Arguments arguments) {
    arguments.insert(arguments.begin(), test::program);
    return test::run_program(std::move(arguments), folder_.path());
  }
  test::Outcome shell(const std::string& command) {
    return test::run_program({"/bin/bash", "-c", command}, folder_.path());
  }
  nlohmann::json json(const std::string& name) {
    return nlohmann::json::parse(test::contents(folder_.path() / name));
  }

  test::TempDir folder_;
  const std::string s1_ = test::data_file("s1.obj").string();
  const std::string points_ = test::data_file("s1_points.csv").string();
};

TEST_F(Usage, WhatDoesNotExistSuggestsTheNearest) {
  const struct {
    Arguments arguments;
    std::string says;
  } cases[] = {
      {{"sovle", "a.obj"}, "did you mean 'solve'?"},
      {{"bake"}, "the commands are solve, mesh, render, probe"},
      {{}, "a command is missing"},
      {{"solve", "a.obj", "--elemnts", "5"}, "did you mean '--elements'?"},
      {{"solve", "a.obj", "--max-lenght=5"}, "did you mean '--max-length'?"},
      {{"render", "a.obj", "-o", "a.png", "--widht", "5"}, "did you mean '--width'?"},
      {{"probe", "a.obj", "-o", "a.csv", "--qqqqqq"}, "there is no option '--qqqqqq'; see"},
      {{"solve", "a.obj", "-x"}, "there is no option '-x'"},
      {{"solve", "a.obj", "b.obj"}, "'b.obj' is one argument too many"}};
  for (const auto& c : cases) {
    const test::Outcome outcome = run(c.arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(c.says), std::string::npos) << outcome.err;
  }
}

TEST_F(Usage, BadValuesNameTheirOption) {
  const Arguments cases[] = {{"solve", s1_, "--elements", "nan"},
                             {"solve", s1_, "--elements", "-5"},
                             {"solve", s1_, "--elements", "1e3"},
                             {"solve", s1_, "--max-length", "inf"},
                             {"solve", s1_, "--max-length", "nan"},
                             {"solve", s1_, "--tolerance", "-0.1"},
                             {"solve", s1_, "--bounces", "1.5"},
                             {"solve", s1_, "--events", "ev,,eee"},
                             {"solve", s1_, "--events", "ev,"},
                             {"solve", s1_, "--events", ""},
                             {"solve", s1_, "--json", ""},
                             {"solve", s1_, "--materials", ""},
                             {"solve", s1_, "--closure", "maybe"},
                             {"solve", s1_, "--threads", "0"},
                             {"solve", s1_, "--factors", "guesses"},
                             {"solve", s1_, "--hemicube", "33"},
                             {"solve", s1_, "--hemicube", "0"},
                             {"probe", s1_, "-o", "a.csv", "--grid", "x", "--spacing", "nan"},
                             {"probe", s1_, "-o", "a.csv", "--spacing", "inf", "--grid", ""},
                             {"render", s1_, "-o", "a.png", "--fov", "nan"},
                             {"render", s1_, "-o", "a.png", "--exposure", "inf"},
                             {"render", s1_, "-o", "a.png", "--width", "-3"},
                             {"render", s1_, "-o", "a.png", "--gloss", "2"},
                             {"render", s1_, "-o", "a.png", "--gloss", "-0.1"},
                             {"study", s1_, "-o", "a", "--tolerances", "0.1,,0.03"},
                             {"study", s1_, "-o", "a", "--tolerances", "0.1,"},
                             {"study", s1_, "-o", "a", "--tolerances", ""},
                             {"render", s1_, "-o", "a.png", "--scale", "square"},
                             {"render", s1_, "-o", "a.png", "--range", "1,nan"},
                             {"render", s1_, "-o", "a.png", "--position", "1", "2", "nan"},
                             {"render", s1_, "-o", "a.png", "--up", "0", "0"}};
  for (const Arguments& arguments : cases) {
    const auto option = std::find_if(arguments.rbegin(), arguments.rend(),
                                     [](const auto& word) { return word.starts_with("--"); });
    const test::Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(*option + ":"), std::string::npos) << outcome.err;
    for (const char* internal : {"CLI", "Validat", "FLOAT", "INT", "{", "Error"})
      EXPECT_EQ(outcome.err.find(internal), std::string::npos) << outcome.err;
  }
}

TEST_F(Usage, HelpShowsChoicesAsWords) {
  for (const char* command : {"solve", "mesh", "render", "probe"}) {
    const std::string help = run({command, "--help"}).out;
    for (const char* internal : {"auto->", "order->", "VALUE", "ENUM", "{", "INT in", "FLOAT"})
      EXPECT_EQ(help.find(internal), std::string::npos) << command << internal;
  }
  EXPECT_NE(run({"solve", "--help"}).out.find("--method fields|matrix"), std::string::npos);
  EXPECT_EQ(run({"solve", s1_, "--closure", "ENFORCE", "--elements", "20", "-q"}).exit_code, 0);
}

TEST_F(Usage, PointsAndTablesMayBeStreams) {
  const std::string program = test::program;
  const test::Outcome outcome =
      shell(program + " probe " + s1_ + " --points - -o - --direct --json r.json <" + points_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  ASSERT_EQ(run({"probe", s1_, "--points", points_, "-o", "o.csv", "--direct", "-q"}).exit_code, 0);
  EXPECT_EQ(outcome.out, test::contents(folder_.path() / "o.csv")) << "and nothing else";
  EXPECT_NE(outcome.err.find("points       7"), std::string::npos) << outcome.err;
  EXPECT_EQ(json("r.json").at("points"), 7);
  const test::Outcome empty = shell(program + " probe " + s1_ + " --points - -o - </dev/null");
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_NE(empty.err.find("standard input"), std::string::npos) << empty.err;
  const test::Outcome report = run({"solve", s1_, "--elements", "20", "-q", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(report.out).at("status"), "done");
}

TEST_F(Usage, RenderWritesItsReport) {
  ASSERT_EQ(run({"render", s1_, "-o", "a.png", "--width", "20", "--height", "10", "--json",
                 "r.json", "-q"})
                .exit_code,
            0);
  const auto report = json("r.json");
  EXPECT_EQ(report.at("status"), "done");
  EXPECT_EQ(report.at("width"), 20);
  EXPECT_EQ(report.at("height"), 10);
  EXPECT_EQ(report.at("outputs"), nlohmann::json({"a.png"}));
  EXPECT_GT(report.at("peak_memory_bytes"), 1'000'000);
  EXPECT_GT(report.at("seconds"), 0);
}

TEST_F(Usage, TheSameCommandWritesTheSameBytes) {
  const auto bytes = [&](const char* file) {
    EXPECT_EQ(run({"solve", s1_, "--elements", "200", "--regions", "-q", "-o", file}).exit_code, 0);
    return test::contents(folder_.path() / file);
  };
  for (const std::string extension : {"vtu", "vtp"}) {
    const std::string first = bytes(("a." + extension).c_str());
    EXPECT_EQ(first, bytes(("a." + extension).c_str()));
    EXPECT_EQ(first, bytes(("b." + extension).c_str())) << "whatever its name";
  }
}

TEST_F(Usage, BouncesCountReflections) {
  // A closed cube of reflectance 1/2 and exitance 1/2: H after n reflections is 1 − 1/2^(n+1).
  folder_.write("cube.obj",
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                "g cube\nf 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n");
  folder_.write("m.json", R"({"cube": {"reflectance": 0.5, "exitance": 0.5}})");
  const auto irradiance = [&](Arguments more) {
    more.insert(more.begin(), {"solve", "cube.obj", "--materials", "m.json", "--elements", "150",
                               "--closure", "enforce", "-q", "--json", "r.json"});
    EXPECT_EQ(run(more).exit_code, 0);
    return json("r.json").at("groups").at(0).at("mean_irradiance_w_per_m2").at(0).get<double>();
  };
  EXPECT_NEAR(irradiance({"--bounces", "0"}), 0.5, 1e-9);
  EXPECT_NEAR(irradiance({"--bounces", "1"}), 0.75, 1e-9);
  EXPECT_NEAR(irradiance({"--bounces", "2"}), 0.875, 1e-9);
  EXPECT_NEAR(irradiance({}), 1, 1e-9);
}

TEST_F(Usage, SolversAgreeAndTellTheirHistory) {
  double right = 0;
  for (const char* solver :
       {"conjugate-gradients", "jacobi", "gauss-seidel", "southwell", "southwell-ambient"}) {
    ASSERT_EQ(
        run({"solve", test::data_file("l_room.obj").string(), "--method", "matrix", "--elements",
             "300", "--solver", solver, "-q", "-o", "o.vtu", "--json", "r.json"})
            .exit_code,
        0);
    const auto report = json("r.json");
    const auto& channel = report.at("radiosity").at("channel").at(0);
    EXPECT_EQ(channel.at("history").size(), channel.at("iterations"));
    EXPECT_LE(channel.at("history").back(), 1e-10);
    const double found = report.at("groups").at(0).at("mean_radiosity_w_per_m2").at(0);
    if (right == 0) right = found;
    EXPECT_NEAR(found, right, 1e-9 * right) << solver;
  }
}

}  // namespace
}  // namespace halfshade
