#include "io/write/write_report.h"

#include "tests/support/files.h"
#include "tests/support/sample_result.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace halfshade {
namespace {

nlohmann::json report_of(const SolveResult& result,
                         const Provenance& provenance = {"1.2", "solve"}) {
  const test::TempDir folder;
  write_report(result, {provenance, {"a.vtu", "b c.png"}, "interrupted", 1.5, 4096},
               folder.path() / "r.json");
  return nlohmann::json::parse(test::contents(folder.path() / "r.json"));
}

TEST(WriteReport, TellsTheRun) {
  SolveResult result = test::sample_result(2);
  result.exchange.factors = 12;
  result.exchange.closed = true;
  result.exchange.closure_error_max = 0.125;
  result.radiosity.channels = 3;
  result.radiosity.channel[1].iterations = 7;
  result.radiosity.channel[2].balance = 1e-12;
  result.interrupted = true;
  const auto json = report_of(result);
  EXPECT_EQ(json.at("version"), "1.2");
  EXPECT_EQ(json.at("command_line"), "solve");
  EXPECT_EQ(json.at("status"), "interrupted");
  EXPECT_EQ(json.at("seconds"), 1.5);
  EXPECT_EQ(json.at("peak_memory_bytes"), 4096);
  EXPECT_EQ(json.at("scene").at("group_names"), nlohmann::json({"floor", "rug"}));
  EXPECT_EQ(json.at("scene").at("material_names"), nlohmann::json({"grey", "lamp"}));
  EXPECT_EQ(json.at("scene").at("camera_names"), nlohmann::json({"above"}));
  EXPECT_EQ(json.at("unit"), "cm");
  EXPECT_EQ(json.at("interrupted"), true);
  EXPECT_EQ(json.at("outputs"), nlohmann::json({"a.vtu", "b c.png"}));
  EXPECT_EQ(json.at("scene").at("faces"), 2);
  EXPECT_EQ(json.at("scene").at("surfaces"), 1);
  EXPECT_EQ(json.at("scene").at("materials"), 2);
  EXPECT_EQ(json.at("repairs").at(0).at("kind"), "coplanar_merged");
  EXPECT_EQ(json.at("repairs").at(0).at("faces"), nlohmann::json({1, 2}))
      << "as the sentence counts them";
  EXPECT_EQ(json.at("repairs").at(0).at("sentence"),
            "face 1, face 2 (line 7) lie in one plane and were joined");
  EXPECT_EQ(json.at("stages").at(0).at("seconds"), 0.25);
  EXPECT_TRUE(json.at("stages").at(0).at("left_out_because").is_null());
  EXPECT_EQ(json.at("stages").at(1).at("left_out_because"), "there is nothing to see");
  EXPECT_EQ(json.at("exchange").at("factors"), 12);
  EXPECT_EQ(json.at("exchange").at("closed"), true);
  EXPECT_EQ(json.at("exchange").at("closure_error_max"), 0.125);
  EXPECT_EQ(json.at("radiosity").at("channel").size(), 3U);
  EXPECT_EQ(json.at("radiosity").at("channel").at(1).at("iterations"), 7);
  EXPECT_EQ(json.at("radiosity").at("channel").at(2).at("balance"), 1e-12);
  EXPECT_EQ(json.at("radiosity").at("converged"), true);
}

TEST(WriteReport, TheHistogramCountsEveryElement) {
  const auto mesh = report_of(test::sample_result(3)).at("mesh");
  EXPECT_EQ(mesh.at("elements"), 18);
  EXPECT_EQ(mesh.at("points"), 16);
  EXPECT_NEAR(mesh.at("min_angle_degrees").get<double>(), 45, 1e-9);  // halves of squares
  int sum = 0;
  for (const int count : mesh.at("min_angle_histogram").at("counts")) sum += count;
  EXPECT_EQ(sum, 18);
}

TEST(WriteReport, GroupsAddUpToTheWhole) {
  // Two elements of area 1/2 each, one a group; H = (1.1, 2.1, 3.1) and a bit more on the second.
  SolveResult result = test::sample_result(1);
  const auto groups = report_of(result).at("groups");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups.at(0).at("name"), "floor");
  EXPECT_EQ(groups.at(0).at("area"), 0.5);
  EXPECT_NEAR(groups.at(0).at("mean_irradiance_w_per_m2").at(1).get<double>(), 2.1, 1e-14);
  EXPECT_NEAR(groups.at(0).at("mean_radiosity_w_per_m2").at(1).get<double>(), 8 + 0.1 * 2.1, 1e-14);
  EXPECT_NEAR(groups.at(0).at("emitted_power").at(2).get<double>(), 3.5, 1e-14);
  EXPECT_NEAR(groups.at(0).at("absorbed_power").at(0).get<double>(), 0.5 * 0.9 * 1.1, 1e-14);
  EXPECT_NEAR(groups.at(1).at("absorbed_power").at(1).get<double>(), 0.5 * 0.6 * (2.1 + 1 / 7.0),
              1e-14);
  EXPECT_EQ(groups.at(1).at("emitted_power").at(0), 0);
}

TEST(WriteReport, SaysWhatAreasAndPowersAreIn) {
  SolveResult result = test::sample_result(1);  // in centimetres
  const auto json = report_of(result);
  EXPECT_EQ(json.at("units").at("length"), "cm");
  EXPECT_EQ(json.at("units").at("area"), "cm²");
  EXPECT_EQ(json.at("units").at("power"), "W/m² · cm²");
  const auto group = json.at("groups").at(0);
  EXPECT_NEAR(group.at("area_m2").get<double>(), 0.5e-4, 1e-18);
  for (const std::string power : {"emitted_power", "absorbed_power"})
    EXPECT_NEAR(group.at(power + "_w").at(2).get<double>(),
                1e-4 * group.at(power).at(2).get<double>(), 1e-18);
  result.unit = "furlong";
  EXPECT_FALSE(report_of(result).at("groups").at(0).contains("area_m2"));
}

TEST(WriteReport, AGreySceneHasOneChannel) {
  SolveResult result = test::sample_result(1);
  result.radiosity.channels = 1;
  const auto json = report_of(result);
  EXPECT_EQ(json.at("radiosity").at("channel").size(), 1U);
  const auto group = json.at("groups").at(0);
  for (const char* key :
       {"mean_radiosity_w_per_m2", "mean_irradiance_w_per_m2", "emitted_power", "absorbed_power"})
    EXPECT_EQ(group.at(key).size(), 1U) << key;
}

TEST(WriteReport, AGroupWithoutElementsIsListedWithoutLight) {
  SolveResult result = test::sample_result(1);
  result.scene.groups.emplace_back("nothing");
  const auto group = report_of(result).at("groups").at(2);
  EXPECT_EQ(group.at("area"), 0);
  EXPECT_EQ(group.at("mean_radiosity_w_per_m2"), nlohmann::json({0.0, 0.0, 0.0}));
}

TEST(WriteReport, IsJsonWhateverIsInIt) {
  SolveResult result = test::sample_result(1);
  result.scene.groups[0] = "\xff\xfe \"quoted\"\n";
  result.radiosity.channel[0].balance = std::numeric_limits<double>::quiet_NaN();
  const auto json = report_of(result, {"1", "\xc3"});
  EXPECT_TRUE(json.at("radiosity").at("channel").at(0).at("balance").is_null());
  EXPECT_EQ(report_of(test::sample_result(0)).at("mesh").at("elements"), 0);
}

TEST(WriteReport, NamesAPlaceThatCannotBeWritten) {
  const test::TempDir folder;
  const auto file = folder.write("file", "");
  test::expect_error([&] { write_report(test::sample_result(1), {}, file / "r.json"); },
                     ErrorCode::unwritable, {"r.json", "Not a directory"});
  test::expect_error([&] { write_report(test::sample_result(1), {}, "/dev/full"); },
                     ErrorCode::unwritable, {"/dev/full", "No space left"});
}

}  // namespace
}  // namespace halfshade
