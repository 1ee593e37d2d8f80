// `halfshade solve --subdivide` on the scene made for it.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace halfshade {
namespace {

using Json = nlohmann::json;

class ReadingRoom : public testing::Test {
 protected:
  test::Outcome solve(std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        test::program, "solve", test::data_file("reading_room.obj").string(), "-q", "-o", "r.vtu",
        "--json",      "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_program(arguments, folder_.path());
  }
  Json report() { return Json::parse(test::contents(folder_.path() / "r.json")); }

  test::TempDir folder_;
};

TEST_F(ReadingRoom, IsDividedAsItsPageSays) {
  const test::Outcome outcome =
      solve({"--method", "matrix", "--no-discontinuity", "--elements", "150", "--subdivide", "2",
             "--gradient", "0.2", "--interpolate"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json all = report(), division = all.at("subdivision");
  ASSERT_EQ(division.at("elements").size(), 2u);
  EXPECT_LE(division.at("patches"), 150);
  EXPECT_GT(division.at("patches"), 100);
  EXPECT_GT(division.at("elements")[0], 2 * division.at("patches").get<int>());
  EXPECT_GT(division.at("elements")[1], 1.5 * division.at("elements")[0].get<int>());
  EXPECT_EQ(division.at("elements")[1], all.at("mesh").at("elements"));
  double arriving = 0;
  for (const Json& group : all.at("groups"))
    arriving +=
        group.at("area").get<double>() * group.at("mean_irradiance_w_per_m2")[0].get<double>();
  EXPECT_NEAR(arriving, 66, 0.2);
}

TEST_F(ReadingRoom, TakesTheseOptionsWithConstantElementsOnly) {
  const std::string needs = "give --method matrix";
  test::expect_sentence(solve({"--subdivide", "2"}), 2, needs);
  test::expect_sentence(solve({"--interpolate"}), 2, needs);
  test::expect_sentence(solve({"--method", "matrix", "--subdivide", "x"}), 2, "--subdivide");
  test::expect_sentence(solve({"--method", "matrix", "--gradient", "0"}), 2, "--gradient");
  test::expect_sentence(solve({"--method", "matrix", "--no-discontinuity", "--elements", "150",
                               "--subdivide", "9", "--max-elements", "1000"}),
                        3, "--max-elements");
}

}  // namespace
}  // namespace halfshade
