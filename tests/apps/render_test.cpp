#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// A folder with results of S1 that pictures are made of: a.vtu, b.vtu (coarser), c.vtp (curves).
class Render : public testing::Test {
 protected:
  void SetUp() override {
    const std::string s1 = test::data_file("s1.obj").string();
    make({"solve", s1, "-o", "a.vtu", "--tolerance", "0.01"});
    make({"solve", s1, "-o", "b.vtu", "--tolerance", "0.1"});
    make({"mesh", s1, "-o", "m.vtu", "--curves", "c.vtp"});
  }

  test::Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {test::program});
    return test::run_program(std::move(arguments), folder_.path());
  }
  test::Outcome render(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"render"});
    arguments.insert(arguments.end(), {"--width", "60", "--height", "40", "--samples", "1"});
    return run(std::move(arguments));
  }
  nlohmann::json report() const {
    return nlohmann::json::parse(test::contents(folder_.path() / "r.json"));
  }
  bool exists(const std::string& name) const { return fs::exists(folder_.path() / name); }

  const test::TempDir folder_;

 private:
  void make(std::vector<std::string> arguments) {
    arguments.emplace_back("-q");
    const test::Outcome outcome = run(std::move(arguments));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
};

TEST_F(Render, AQuantityTellsItsRangeAndUnit) {
  const test::Outcome outcome =
      render({"a.vtu", "-o", "a.png", "--quantity", "irradiance", "--json", "r.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("range        0 to "), std::string::npos) << outcome.out;
  const auto quantity = report().at("quantity");
  EXPECT_EQ(quantity.at("name"), "irradiance");
  EXPECT_EQ(quantity.at("channel"), "mean of R, G, B");
  EXPECT_EQ(quantity.at("unit"), "W/m²");
  EXPECT_GT(quantity.at("range").at(1).get<double>(), 0);
  EXPECT_GT(report().at("width").get<int>(), 60) << "with its legend";
  EXPECT_FALSE(report().contains("exposure"));
}

TEST_F(Render, EveryArrayOfEveryResultCanBeDrawn) {
  for (const std::string name : {"radiosity", "direct_irradiance", "error_estimate", "order",
                                 "reflectance", "exitance", "region", "quality", "face"})
    EXPECT_EQ(render({"a.vtu", "-o", name + ".png", "--quantity", name, "--mesh"}).exit_code, 0)
        << name;
  for (const std::string name : {"region", "edge_order", "group"})
    EXPECT_EQ(
        render({"m.vtu", "-o", name + ".png", "--quantity", name, "--channel", "0"}).exit_code, 0)
        << name;
  EXPECT_EQ(render({"a.vtu", "-o", "log.png", "--quantity", "irradiance", "--scale", "log",
                    "--range", "1e-3,1", "--curves", "c.vtp", "--flat"})
                .exit_code,
            0);
}

TEST_F(Render, TheSameCommandMakesTheSameBytes) {
  for (const std::string name : {"1.png", "2.png"})
    ASSERT_EQ(render({"a.vtu", "-o", name, "--quantity", "irradiance", "--curves", "c.vtp",
                      "--threads", name == "1.png" ? "1" : "2"})
                  .exit_code,
              0);
  EXPECT_EQ(test::contents(folder_.path() / "1.png"), test::contents(folder_.path() / "2.png"));
}

TEST_F(Render, ADifferenceIsMeasuredAndStandsBesideBoth) {
  ASSERT_EQ(render({"b.vtu", "-o", "d.png", "--compare", "a.vtu", "--quantity", "irradiance",
                    "--json", "r.json"})
                .exit_code,
            0);
  const auto alone = report();
  const double rms = alone.at("quantity").at("difference").at("relative_rms");
  EXPECT_GT(rms, 1e-3);
  EXPECT_LT(rms, 0.3) << "the coarser result is off by about 0.1 in the mean";
  EXPECT_DOUBLE_EQ(alone.at("quantity").at("range").at(0).get<double>(),
                   -alone.at("quantity").at("range").at(1).get<double>());
  for (const bool is_false : {false, true}) {
    std::vector<std::string> arguments = {"b.vtu",          "-o",     "s.png", "--compare", "a.vtu",
                                          "--side-by-side", "--json", "r.json"};
    if (is_false) arguments.insert(arguments.end(), {"--quantity", "irradiance"});
    ASSERT_EQ(render(arguments).exit_code, 0);
    EXPECT_GT(report().at("width").get<int>(), 180);
    EXPECT_EQ(report().contains("exposure"), !is_false);
  }
  ASSERT_EQ(render({"a.vtu", "-o", "d.png", "--compare", "a.vtu", "--json", "r.json"}).exit_code,
            0);
  EXPECT_EQ(report().at("quantity").at("difference").at("largest").get<double>(), 0);
}

TEST_F(Render, RadianceIsWrittenAsHdr) {
  ASSERT_EQ(render({"a.vtu", "-o", "a.hdr"}).exit_code, 0);
  EXPECT_EQ(test::contents(folder_.path() / "a.hdr").substr(0, 11), "#?RADIANCE\n");
}

TEST_F(Render, WhatMakesNoSenseIsSaidInASentence) {
  const std::string s1 = test::data_file("s1.obj").string();
  const std::string bars = test::data_file("bars.obj").string();
  ASSERT_EQ(run({"solve", bars, "-o", "bars.vtu", "--tolerance", "0.3", "-q"}).exit_code, 0);
  struct Mistake {
    std::vector<std::string> arguments;
    int exit_code;
    std::string part;
  };
  const std::vector<Mistake> mistakes = {
      {{"a.vtu", "-o", "o.png", "--quantity", "colour"}, 2, "radiosity, irradiance"},
      {{"a.vtu", "-o", "o.png", "--quantity", "irradiance", "--channel", "7"}, 2, "0 to 2"},
      {{"a.vtu", "-o", "o.png", "--quantity", "order", "--range", "5,1"}, 2, "does not rise"},
      {{"a.vtu", "-o", "o.png", "--quantity", "order", "--range", "1,1"}, 2, "does not rise"},
      {{"a.vtu", "-o", "o.png", "--quantity", "order", "--range", "1"}, 2, "two numbers"},
      {{"a.vtu", "-o", "o.png", "--quantity", "order", "--range", "0,inf"}, 2, "two numbers"},
      {{"a.vtu", "-o", "o.png", "--quantity", "order", "--scale", "log", "--range", "0,1"},
       2,
       "above zero"},
      {{"a.vtu", "-o", "o.png", "--range", "0,1"}, 2, "--quantity"},
      {{"a.vtu", "-o", "o.png", "--quantity", "irradiance", "--exposure", "2"}, 2, "--range"},
      {{"a.vtu", "-o", "o.png", "--side-by-side"}, 2, "--compare"},
      {{"a.vtu", "-o", "o.png", "--compare", "b.vtu", "--scale", "log"}, 2, "logarithmic"},
      {{"a.vtu", "-o", "o.png", "--compare", "bars.vtu"}, 3, "same scene"},
      {{"a.vtu", "-o", "o.png", "--compare", "none.vtu"}, 3, "none.vtu"},
      {{"a.vtu", "-o", "o.png", "--compare", s1}, 3, "s1.obj"},
      {{"a.vtu", "-o", "o.png", "--curves", "none.vtp"}, 3, "none.vtp"},
      {{"a.vtu", "-o", "o.png", "--curves", "a.vtu"}, 3, ".vtp"},
      {{"m.vtu", "-o", "o.png"}, 3, "'radiosity'"},
      {{s1, "-o", "o.png", "--quantity", "irradiance"}, 2, "solve"},
      {{s1, "-o", "o.hdr"}, 2, "solve"},
      {{"a.vtu", "-o", "o.hdr", "--mesh"}, 2, ".hdr"},
      {{"a.vtu", "-o", "o.exr"}, 2, ".exr"},
      {{"a.vtu", "-o", "c.vtp", "--curves", "c.vtp"}, 2, "--curves"}};
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(testing::PrintToString(mistake.arguments));
    test::expect_sentence(render(mistake.arguments), mistake.exit_code, mistake.part);
    EXPECT_FALSE(exists("o.png") || exists("o.hdr"));
  }
}

TEST_F(Render, RaysAreTracedThroughAScene) {
  const std::string s1 = test::data_file("s1.obj").string();
  const test::Outcome outcome =
      render({s1, "-o", "walks.png", "--method", "reference", "--json", "r.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("standard error"), std::string::npos) << outcome.out;
  EXPECT_EQ(report().at("samples"), 8) << "one for each batch";
  EXPECT_GT(report().at("relative_standard_error").get<double>(), 0);
  EXPECT_GT(report().at("exposure").get<double>(), 0);
  EXPECT_EQ(report().at("width"), 60);
  const std::string once = test::contents(folder_.path() / "walks.png");
  EXPECT_EQ(
      render({s1, "-o", "walks.png", "--method", "reference", "-q", "--threads", "1"}).exit_code,
      0);
  EXPECT_EQ(test::contents(folder_.path() / "walks.png").size(), once.size());
  ASSERT_EQ(render({s1, "-o", "c.hdr", "--method", "classic", "--shadows", "hard", "--highlight",
                    "0.2", "--mirror", "occluder", "-q"})
                .exit_code,
            0);
  EXPECT_TRUE(exists("c.hdr"));
  test::expect_sentence(render({"a.vtu", "-o", "x.png", "--method", "reference"}), 2, "the scene");
  test::expect_sentence(render({s1, "-o", "x.png", "--shadows", "hard"}), 2, "--method classic");
  test::expect_sentence(render({s1, "-o", "x.png", "--method", "classic", "--mirror", "nobody"}), 2,
                        "'nobody'");
  test::expect_sentence(render({s1, "-o", "x.png", "--method", "reference", "--mesh"}), 2,
                        "--mesh");
  test::expect_sentence(render({s1, "-o", "x.hdr", "--method", "reference", "--exposure", "1"}), 2,
                        "exposure");
  EXPECT_FALSE(exists("x.png"));
}

TEST_F(Render, RaysAreDistributedOverASolution) {
  const test::Outcome outcome = render({"a.vtu", "-o", "l.png", "--lens", "0.1", "--focus", "4",
                                        "--gloss", "0.3", "--json", "r.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_GT(report().at("relative_standard_error").get<double>(), 0);
  EXPECT_TRUE(exists("l.png"));
  const auto moved = [&](const char* name, const char* way) {
    EXPECT_EQ(render({"a.vtu", "-o", name, "--move", "0", way, "0", "--exposure", "1"}).exit_code,
              0);
    return test::contents(folder_.path() / name);
  };
  const std::string still = moved("still.png", "0"), blurred = moved("blurred.png", "0.5");
  EXPECT_NE(blurred, still);
  EXPECT_EQ(moved("again.png", "0.5"), blurred) << "the same bytes";
  test::expect_sentence(render({"a.vtu", "-o", "x.png", "--move", "1", "0"}), 2, "--move");
  test::expect_sentence(render({"a.vtu", "-o", "x.png", "--move", "1", "0", "inf"}), 2, "finite");
  test::expect_sentence(
      render({"a.vtu", "-o", "x.png", "--move", "1", "0", "0", "--curves", "c.vtp"}), 2, "--move");
  test::expect_sentence(
      render({test::data_file("s1.obj").string(), "-o", "x.png", "--move", "1", "0", "0"}), 2,
      "a result");
  test::expect_sentence(render({"a.vtu", "-o", "x.png", "--lens", "0.1"}), 2, "--focus");
  test::expect_sentence(render({"a.vtu", "-o", "x.png", "--gloss", "0.1", "--mesh"}), 2, "--gloss");
  test::expect_sentence(render({test::data_file("s1.obj").string(), "-o", "x.png", "--gloss", "1"}),
                        2, "a result");
  EXPECT_FALSE(exists("x.png"));
}

}  // namespace
}  // namespace halfshade
