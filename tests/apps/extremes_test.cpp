// Scenes of every size, distance and stiffness through the program, each with the law or closed
// form that judges it. HALFSHADE_EXTREMES=table.md appends what was asked, expected and got to a
// file:
//   HALFSHADE_EXTREMES=$PWD/table.md build/release/tests/apps_tests --gtest_filter='*Extremes*'

#include "tests/support/analytic.h"
#include "tests/support/files.h"
#include "tests/support/process.h"
#include "tests/support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace halfshade {
namespace {

using test::SceneText;

/// A scene, what is asked of it, and the answer.
struct Extreme {
  std::string name;
  SceneText scene;
  std::string point;                    ///< "x,y,z,nx,ny,nz": probe there; empty: solve
  std::string quantity = "irradiance";  ///< mean of `group` after solve: or "radiosity"
  std::string group = "floor";
  double expected = 0, tolerance = 0;  ///< the latter relative; absolute where 0 is expected
  std::vector<std::string> options;
};

void PrintTo(const Extreme& extreme, std::ostream* out) { *out << extreme.name; }

const std::string at_origin = "0,0,0,0,0,1";

/// A point above the middle of a square: what it receives from a unit exitance.
double under_square(double half, double height) {
  return 4 * test::point_parallel_rectangle(half, half, height);
}

SceneText plates(double gap, double half_light = 0.5) {
  SceneText scene;
  scene.floor(0.5).lamp(half_light, gap);
  return scene;
}

void gaps(std::vector<Extreme>& all) {
  for (int k = -7; k <= 6; ++k) {
    const double gap = std::pow(10, k);
    all.push_back({fmt::format("gap_1e{}_probe", k),
                   plates(gap),
                   at_origin,
                   "",
                   "",
                   under_square(0.5, gap),
                   1e-9,
                   {"--direct"}});
    if (k <= 3)
      all.push_back({fmt::format("gap_1e{}_solve", k),
                     plates(gap),
                     "",
                     "irradiance",
                     "floor",
                     test::opposed_rectangles(1, 1, gap),
                     0.01,
                     {"--elements", "400"}});
  }
}

void far_things(std::vector<Extreme>& all) {
  for (const int k : {3, 6, 9, 12}) {
    const double far = std::pow(10, k);
    SceneText scene = plates(1);
    scene.polygon("dark", "elsewhere", {{far, 0, 0}, {1.000001 * far, 0, 0}, {far, 1, 1}});
    all.push_back({fmt::format("triangle_at_1e{}_probe", k),
                   scene,
                   at_origin,
                   "",
                   "",
                   under_square(0.5, 1),
                   1e-12,
                   {"--direct"}});
    all.push_back({fmt::format("triangle_at_1e{}_solve", k),
                   scene,
                   "",
                   "irradiance",
                   "floor",
                   test::opposed_rectangles(1, 1, 1),
                   1e-3,
                   {"--elements", "400"}});
  }
  for (const double distance : {1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1.5e11}) {
    SceneText scene;
    scene.floor(2).table(0.5, 0.1).lamp(0.00465 * distance, distance);
    const double sun = under_square(0.00465 * distance, distance);
    all.push_back({fmt::format("sun_at_{:g}_beside", distance),
                   scene,
                   "1,0.2,0,0,0,1",
                   "",
                   "",
                   sun,
                   1e-6,
                   {"--direct"}});
    all.push_back({fmt::format("sun_at_{:g}_under", distance),
                   scene,
                   "0.1,0.2,0,0,0,1",
                   "",
                   "",
                   0,
                   1e-12,
                   {"--direct"}});
  }
  for (const int k : {1, 3, 5, 6, 9})
    all.push_back({fmt::format("light_1e{}_wide", k),
                   plates(1, 0.5 * std::pow(10, k)),
                   at_origin,
                   "",
                   "",
                   under_square(0.5 * std::pow(10, k), 1),
                   1e-9,
                   {"--direct"}});
  for (const int k : {3, 6, 9, 12}) {
    SceneText scene = plates(std::pow(10, -k), 0.5 * std::pow(10, -k));
    all.push_back({fmt::format("light_1e-{}_wide", k),
                   scene,
                   at_origin,
                   "",
                   "",
                   under_square(0.5, 1),
                   1e-9,
                   {"--direct"}});
  }
}

void units(std::vector<Extreme>& all) {
  for (const int k : {-30, -20, -10, -6, -3, 3, 6, 10, 20, 30}) {
    const double unit = std::pow(10, k);
    SceneText scene;
    scene.floor(2 * unit).table(0.4 * unit, unit).lamp(0.5 * unit, 2 * unit);
    // Beside the table, where it hides nothing of the lamp.
    const double x = 1.9;
    all.push_back({fmt::format("unit_1e{}_probe", k),
                   scene,
                   fmt::format("{:.17g},0,0,0,0,1", x * unit),
                   "",
                   "",
                   test::point_parallel_rectangle(-0.5 - x, 0.5 - x, -0.5, 0.5, 2),
                   1e-12,
                   {"--direct"}});
    all.push_back({fmt::format("unit_1e{}_solve", k),
                   plates(1).scale(unit),
                   "",
                   "irradiance",
                   "floor",
                   test::opposed_rectangles(1, 1, 1),
                   1e-3,
                   {"--elements", "400"}});
  }
  for (const int k : {-190, -150, -100, -30, 30, 100, 150, 190}) {
    SceneText scene = plates(1);
    scene.exitance(std::pow(10, k));
    all.push_back({fmt::format("exitance_1e{}", k),
                   scene,
                   "",
                   "irradiance",
                   "floor",
                   std::pow(10, k) * test::opposed_rectangles(1, 1, 1),
                   1e-3,
                   {"--elements", "400"}});
  }
  for (const double away : {1e3, 1e5, 1e6}) {
    SceneText scene = plates(1);
    scene.move({away, -away, away});
    all.push_back({fmt::format("moved_by_{:g}", away),
                   scene,
                   fmt::format("{},{},{},0,0,1", away, -away, away),
                   "",
                   "",
                   under_square(0.5, 1),
                   1e-9,
                   {"--direct"}});
  }
}

/// A closed cube of side 1 in which every wall emits E = 1.
SceneText furnace(double rho) {
  SceneText scene;
  scene.room("wall", "walls", {0, 0, 0}, 1).reflectance("wall", rho, 1);
  return scene;
}

void furnaces(std::vector<Extreme>& all) {
  for (const double absorbed : {1., 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12}) {
    const double rho = 1 - absorbed;
    all.push_back({fmt::format("furnace_1-rho_{:g}", absorbed),
                   furnace(rho),
                   "",
                   "radiosity",
                   "walls",
                   1 / (1 - rho),
                   1e-6,
                   {"--elements", "150"}});
  }
  // A sheet that is seen from both sides, close above the floor of a furnace.
  for (const double height : {1e-3, 1e-5, 1e-7}) {
    SceneText scene = furnace(0.7);
    scene.polygon("wall", "sheet",
                  {{0.3, 0.3, height}, {0.7, 0.3, height}, {0.7, 0.7, height}, {0.3, 0.7, height}});
    scene.polygon("wall", "sheet",
                  {{0.3, 0.7, height}, {0.7, 0.7, height}, {0.7, 0.3, height}, {0.3, 0.3, height}});
    all.push_back({fmt::format("sheet_{:g}_above_a_floor", height),
                   scene,
                   "",
                   "radiosity",
                   "sheet",
                   1 / 0.3,
                   1e-3,
                   {"--elements", "600"}});
  }
  // Two rooms that do not see each other.
  SceneText rooms;
  rooms.room("dim", "dim_room", {0, 0, 0}, 1).reflectance("dim", 0.7, 1e-30);
  rooms.room("bright", "bright_room", {3, 0, 0}, 1).reflectance("bright", 0.7, 1e30);
  for (const bool bright : {false, true})
    all.push_back({bright ? "two_rooms_bright" : "two_rooms_dim",
                   rooms,
                   "",
                   "radiosity",
                   bright ? "bright_room" : "dim_room",
                   (bright ? 1e30 : 1e-30) / 0.3,
                   1e-6,
                   {"--elements", "300"}});
}

void turned_and_doubled(std::vector<Extreme>& all) {
  for (const std::string option : {"--flip", "--orient"}) {
    SceneText scene;
    scene.room("wall", "walls", {0, 0, 0}, -1).reflectance("wall", 0.5, 1);
    all.push_back({"outward_normals" + option,
                   scene,
                   "",
                   "radiosity",
                   "walls",
                   2,
                   1e-6,
                   {"--elements", "150", option}});
  }
  SceneText doubled = plates(1);
  doubled.floor(0.5).lamp(0.5, 1);
  all.push_back(
      {"everything_twice", doubled, at_origin, "", "", under_square(0.5, 1), 1e-12, {"--direct"}});
  SceneText overlapping = plates(1);
  overlapping.lamp(0.3, 1);
  all.push_back({"lamp_over_lamp",
                 overlapping,
                 at_origin,
                 "",
                 "",
                 under_square(0.5, 1),
                 1e-12,
                 {"--direct"}});
}

std::vector<Extreme> extremes() {
  std::vector<Extreme> all;
  gaps(all);
  far_things(all);
  units(all);
  furnaces(all);
  turned_and_doubled(all);
  return all;
}

class Extremes : public testing::TestWithParam<Extreme> {
 protected:
  double probed() {
    folder_.write("points.csv", "x,y,z,nx,ny,nz\n" + GetParam().point + "\n");
    std::vector<std::string> line = {HALFSHADE_PROGRAM, "probe", "scene.obj", "--points",
                                     "points.csv",      "-o",    "out.csv",   "-q"};
    line.insert(line.end(), GetParam().options.begin(), GetParam().options.end());
    outcome_ = test::run_program(line, folder_.path());
    std::istringstream table(test::contents(folder_.path() / "out.csv"));
    std::string row, cell;
    for (std::string next; std::getline(table, next);) row = next;
    std::istringstream cells(row);
    for (int column = 0; column < 7; ++column) std::getline(cells, cell, ',');
    return cell.empty() ? std::nan("") : std::stod(cell);
  }

  double solved() {
    std::vector<std::string> line = {HALFSHADE_PROGRAM, "solve",  "scene.obj", "-o",
                                     "out.vtu",         "--json", "out.json",  "-q"};
    line.insert(line.end(), GetParam().options.begin(), GetParam().options.end());
    outcome_ = test::run_program(line, folder_.path());
    const auto report =
        nlohmann::json::parse(test::contents(folder_.path() / "out.json"), nullptr, false);
    if (report.is_discarded()) return std::nan("");
    for (const auto& group : report["groups"])
      if (group["name"] == GetParam().group)
        return group["mean_" + GetParam().quantity + "_w_per_m2"][0];
    return std::nan("");
  }

  const test::TempDir folder_;
  test::Outcome outcome_;
};

TEST_P(Extremes, GiveTheKnownAnswer) {
  const Extreme& extreme = GetParam();
  folder_.write("scene.mtl", extreme.scene.mtl());
  folder_.write("scene.obj", "mtllib scene.mtl\n" + extreme.scene.obj());
  const double got = extreme.point.empty() ? solved() : probed();
  EXPECT_EQ(outcome_.exit_code, 0) << outcome_.err;
  const double scale = extreme.expected != 0 ? std::abs(extreme.expected) : 1;
  EXPECT_LE(std::abs(got - extreme.expected) / scale, extreme.tolerance)
      << "expected " << extreme.expected << ", got " << got << "\n"
      << outcome_.err;
  EXPECT_FALSE(std::isnan(got)) << outcome_.err;
  if (const char* path = std::getenv("HALFSHADE_EXTREMES"))
    std::ofstream(path, std::ios::app)
        << fmt::format("| {} | {:.10g} | {:.10g} | {:.1e} |\n", extreme.name, extreme.expected, got,
                       std::abs(got - extreme.expected) / scale);
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(extremes()), [](const auto& instance) {
  std::string name = instance.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace halfshade
