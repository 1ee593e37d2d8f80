#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace halfshade {
namespace {

/// The report of a run of solve with constant elements.
nlohmann::json solved(const std::string& scene, const std::string& factors) {
  const test::TempDir folder;
  const test::Outcome outcome = test::run_program(
      {test::program, "solve", test::data_file(scene).string(), "-q", "--method", "matrix",
       "--elements", "400", "--direct-light", "matrix", "--no-discontinuity", "--factors", factors,
       "-o", "out.vtu", "--json", "report.json"},
      folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return nlohmann::json::parse(test::contents(folder.path() / "report.json"));
}

double irradiance_of(const nlohmann::json& report, const std::string& group) {
  for (const auto& one : report.at("groups"))
    if (one.at("name") == group) return one.at("mean_irradiance_w_per_m2").at(0);
  ADD_FAILURE() << "there is no group " << group;
  return 0;
}

TEST(FactorsOption, EachWayGivesAboutTheSameLight) {
  const auto rays = solved("l_room.obj", "rays");
  const std::string group = rays.at("groups").at(0).at("name");
  for (const std::string factors : {"hemicube", "exact"}) {
    const auto report = solved("l_room.obj", factors);
    EXPECT_NEAR(irradiance_of(report, group) / irradiance_of(rays, group), 1, 0.05) << factors;
    EXPECT_TRUE(report.at("exchange").at("closure_enforced").get<bool>());
    EXPECT_EQ(report.at("exchange").at("rays").get<std::size_t>() > 0, factors == "hemicube");
  }
}

TEST(FactorsOption, AFurnaceStaysOneWithEach) {
  for (const std::string factors : {"hemicube", "exact"}) {
    const auto report = solved("furnace_cube.obj", factors);
    for (const auto& group : report.at("groups"))
      EXPECT_NEAR(group.at("mean_radiosity_w_per_m2").at(0).get<double>(), 1, 1e-9) << factors;
  }
}

}  // namespace
}  // namespace halfshade
