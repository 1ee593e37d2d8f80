// Scenes of every size, distance and stiffness through the program, each with the law or closed
// form that judges it. HALFSHADE_EXTREMES=table.md appends what was asked, expected and got to a
// file:
//   HALFSHADE_EXTREMES=$PWD/table.md build/release/tests/apps_tests --gtest_filter='*Extremes*'

#include "tests/support/analytic.h"
#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

using test::SceneText;

/// A scene, what is asked of it, and the answer.
struct Extreme {
  std::string name;
  SceneText scene;
  double expected = 0;
  double tolerance = 0;         ///< relative; absolute where 0 is expected
  std::string point;            ///< "x,y,z,nx,ny,nz": the direct irradiance there; empty: solve
  std::string quantity, group;  ///< mean "irradiance" or "radiosity" of a group after solve
  std::vector<std::string> options;
};

void PrintTo(const Extreme& extreme, std::ostream* out) { *out << extreme.name; }

Extreme probe(std::string name, SceneText scene, std::string point, double expected,
              double tolerance = 1e-9) {
  return {std::move(name), std::move(scene), expected, tolerance, std::move(point), "", "",
          {"--direct"}};
}

/// Mean irradiance of the floor.
Extreme solve_floor(std::string name, SceneText scene, double expected, double tolerance = 1e-3) {
  return {std::move(name), std::move(scene),     expected, tolerance, "", "irradiance",
          "floor",         {"--elements", "400"}};
}

/// Mean radiosity of a group.
Extreme solve_group(std::string name, SceneText scene, std::string group, double expected,
                    double tolerance, std::vector<std::string> options) {
  return {std::move(name), std::move(scene), expected,          tolerance, "",
          "radiosity",     std::move(group), std::move(options)};
}

const std::string origin = "0,0,0,0,0,1";

/// A point below the middle of a square: what it receives from a unit exitance.
double under_square(double half, double height) {
  return 4 * test::point_parallel_rectangle(half, half, height);
}

SceneText plates(double gap, double half_light = 0.5) {
  return SceneText().floor(0.5).lamp(half_light, gap);
}

void gaps(std::vector<Extreme>& all) {
  for (int k = -7; k <= 6; ++k) {
    const double gap = std::pow(10, k);
    all.push_back(
        probe(fmt::format("gap_1e{}_probe", k), plates(gap), origin, under_square(0.5, gap)));
    // Farther apart, the closed form of the mean loses its digits.
    if (k <= 2)
      all.push_back(solve_floor(fmt::format("gap_1e{}_solve", k), plates(gap),
                                test::opposed_rectangles(1, 1, gap), 0.01));
  }
}

/// A lamp that shines to both sides, close above a floor: its underside lights the floor with all
/// it has, whichever way round it goes and however large the floor is.
void lamps_above_floors(std::vector<Extreme>& all) {
  for (const double floor : {4., 100., 1000.})
    for (const double gap : {1e-6, 5e-5, 1e-4})
      for (const bool up : {true, false}) {
        SceneText scene = SceneText().floor(floor / 2);
        up ? scene.square("light", "lamp", 0.5, gap) : scene.lamp(0.5, gap);
        const std::string name =
            fmt::format("lamp_{:g}_above_{:g}_{}", gap, floor, up ? "up" : "down");
        all.push_back(probe(name + "_probe", scene, "0.1,0.1,0,0,0,1",
                            test::point_parallel_rectangle(-0.6, 0.4, -0.6, 0.4, gap), 1e-12));
        all.back().options.insert(all.back().options.end(), {"--materials", "two_sided.json"});
        all.push_back(solve_floor(name + "_solve", scene, 1 / (floor * floor)));
        all.back().options = {"--materials", "two_sided.json", "--tolerance", "0.1"};
      }
}

void far_triangles(std::vector<Extreme>& all) {
  for (const int k : {3, 6, 9, 12}) {
    const double far = std::pow(10, k);
    SceneText scene = plates(1);
    scene.polygon("dark", "elsewhere", {{far, 0, 0}, {1.000001 * far, 0, 0}, {far, 1, 1}});
    all.push_back(probe(fmt::format("triangle_at_1e{}_probe", k), scene, origin,
                        under_square(0.5, 1), 1e-12));
    all.push_back(solve_floor(fmt::format("triangle_at_1e{}_solve", k), scene,
                              test::opposed_rectangles(1, 1, 1)));
  }
}

void suns(std::vector<Extreme>& all) {
  for (const double distance : {1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1.5e11}) {
    const double half = 0.00465 * distance, sun = under_square(half, distance);
    const SceneText scene = SceneText().floor(2).table(0.5, 0.1).lamp(half, distance);
    const std::string name = fmt::format("sun_at_{:g}", distance);
    all.push_back(probe(name + "_beside", scene, "1,0.2,0,0,0,1", sun));
    all.push_back(probe(name + "_under", scene, "0.1,0.2,0,0,0,1", 0));
    // The table hides the sun from as much of the floor as it covers.
    all.push_back(solve_floor(name + "_solve", scene, 15. / 16 * sun));
  }
}

void light_extremes(std::vector<Extreme>& all) {
  for (const int k : {1, 3, 5, 6, 9}) {
    const double half = 0.5 * std::pow(10, k);
    all.push_back(
        probe(fmt::format("light_1e{}_wide", k), plates(1, half), origin, under_square(half, 1)));
  }
  for (const int k : {-3, -6, -9, -12}) {
    const double size = std::pow(10, k);
    all.push_back(probe(fmt::format("light_1e{}_wide", k), plates(size, 0.5 * size), origin,
                        under_square(0.5, 1)));
  }
}

void units(std::vector<Extreme>& all) {
  for (const int k : {-30, -20, -10, -6, -3, 3, 6, 10, 20, 30}) {
    const double unit = std::pow(10, k), x = 1.9;  // where the table hides nothing of the lamp
    all.push_back(probe(fmt::format("unit_1e{}_probe", k),
                        SceneText().floor(2).table(0.4, 1).lamp(0.5, 2).scale(unit),
                        fmt::format("{:.17g},0,0,0,0,1", x * unit),
                        test::point_parallel_rectangle(-0.5 - x, 0.5 - x, -0.5, 0.5, 2), 1e-12));
    all.push_back(solve_floor(fmt::format("unit_1e{}_solve", k), plates(1).scale(unit),
                              test::opposed_rectangles(1, 1, 1)));
  }
  for (const int k : {-190, -150, -100, -30, 30, 100, 150, 190}) {
    const double exitance = std::pow(10, k);
    all.push_back(solve_floor(fmt::format("exitance_1e{}", k), plates(1).exitance(exitance),
                              exitance * test::opposed_rectangles(1, 1, 1)));
  }
  for (const double away : {1e3, 1e5, 1e6})
    all.push_back(probe(fmt::format("moved_by_{:g}", away), plates(1).move({away, -away, away}),
                        fmt::format("{0},-{0},{0},0,0,1", away), under_square(0.5, 1)));
}

/// A closed cube of side 1 in which every wall emits E = 1.
SceneText furnace_of(double rho) {
  return SceneText().room("wall", "walls", {0, 0, 0}, 1).reflectance("wall", rho, 1);
}

void furnaces(std::vector<Extreme>& all) {
  for (const double absorbed : {1., 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12}) {
    const double rho = 1 - absorbed;
    all.push_back(solve_group(fmt::format("furnace_absorbs_{:g}", absorbed), furnace_of(rho),
                              "walls", 1 / (1 - rho), 1e-6, {"--elements", "150"}));
  }
  for (const double far : {1e3, 1e6, 1e9})
    all.push_back(
        solve_group(fmt::format("furnace_triangle_at_{:g}", far),
                    furnace_of(0.5).polygon("dark", "elsewhere",
                                            {{far, 0, 0}, {1.1 * far, 0, 0}, {far, far, 1}}),
                    "walls", 2, 1e-6, {"--elements", "150"}));
  // A sheet that is seen from both sides, close above the floor of a furnace, as two faces and as
  // one.
  for (const double height : {1e-3, 1e-5, 1e-7}) {
    std::vector<Vec3> sheet = {
        {0.3, 0.3, height}, {0.7, 0.3, height}, {0.7, 0.7, height}, {0.3, 0.7, height}};
    SceneText scene = furnace_of(0.7).polygon("wall", "sheet", sheet);
    const SceneText both =
        furnace_of(0.7).reflectance("light", 0.7, 1).polygon("light", "sheet", sheet);
    all.push_back(solve_group(fmt::format("two_sided_sheet_{:g}_above_a_floor", height), both,
                              "sheet", 1 / 0.3, 1e-3,
                              {"--elements", "600", "--materials", "two_sided.json"}));
    std::reverse(sheet.begin(), sheet.end());
    scene.polygon("wall", "sheet", sheet);
    for (const char* group : {"sheet", "walls"})
      all.push_back(solve_group(fmt::format("{}_sheet_{:g}_above_a_floor", group, height), scene,
                                group, 1 / 0.3, 1e-3, {"--elements", "600"}));
  }
}

/// A unit box whose lid, the lamp, is lifted a little. To first order in the gap, ½ of what arrives
/// everywhere gets out for each unit of its length and width from below, and π / 8 from the lid.
void lifted_lids(std::vector<Extreme>& all) {
  for (const double gap : {1e-3, 1e-4, 1e-5, 3e-6}) {
    const double absorbed = gap / 10, z = 1 + gap;
    SceneText scene = SceneText()
                          .reflectance("wall", 1 - absorbed, 0)
                          .reflectance("lamp", 1 - absorbed, 1)
                          .polygon("lamp", "lid", {{0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z}})
                          .polygon("wall", "walls", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const std::vector<Vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 &a = corners[k], &b = corners[(k + 1) % 4];
      scene.polygon("wall", "walls",
                    {{a.x(), a.y(), 0}, {a.x(), a.y(), 1}, {b.x(), b.y(), 1}, {b.x(), b.y(), 0}});
    }
    all.push_back(solve_group(fmt::format("lid_lifted_by_{:g}", gap), scene, "walls",
                              (1 - absorbed) / (6 * absorbed + 4 * gap * (0.5 + M_PI / 8)), 0.01,
                              {"--tolerance", "0.02"}));
  }
}

void rooms(std::vector<Extreme>& all) {
  const SceneText scene = SceneText()
                              .room("dim", "dim_room", {0, 0, 0}, 1)
                              .reflectance("dim", 0.7, 1e-30)
                              .room("bright", "bright_room", {3, 0, 0}, 1)
                              .reflectance("bright", 0.7, 1e30);
  const std::vector<std::string> options = {"--elements", "300"};
  all.push_back(solve_group("two_rooms_dim", scene, "dim_room", 1e-30 / 0.3, 1e-6, options));
  all.push_back(solve_group("two_rooms_bright", scene, "bright_room", 1e30 / 0.3, 1e-6, options));
  for (const std::string option : {"--flip", "--orient"})
    all.push_back(
        solve_group("outward_normals" + option,
                    SceneText().room("wall", "walls", {0, 0, 0}, -1).reflectance("wall", 0.5, 1),
                    "walls", 2, 1e-6, {"--elements", "150", option}));
}

void doubled(std::vector<Extreme>& all) {
  all.push_back(probe("everything_twice", plates(1).floor(0.5).lamp(0.5, 1), origin,
                      under_square(0.5, 1), 1e-12));
  all.push_back(
      probe("lamp_over_lamp", plates(1).lamp(0.3, 1), origin, under_square(0.5, 1), 1e-12));
}

std::vector<Extreme> extremes() {
  std::vector<Extreme> all;
  for (const auto& family : {gaps, lamps_above_floors, far_triangles, suns, light_extremes, units,
                             furnaces, lifted_lids, rooms, doubled})
    family(all);
  return all;
}

class Extremes : public testing::TestWithParam<Extreme> {
 protected:
  double probed() {
    folder_.write("points.csv", "x,y,z,nx,ny,nz\n" + GetParam().point + "\n");
    std::vector<std::string> line = {test::program, "probe", "scene.obj", "--points",
                                     "points.csv",  "-o",    "out.csv",   "-q"};
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
    std::vector<std::string> line = {test::program, "solve",  "scene.obj", "-o",
                                     "out.vtu",     "--json", "out.json",  "-q"};
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
  folder_.write("two_sided.json", R"({"light": {"two_sided": true}})");
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
