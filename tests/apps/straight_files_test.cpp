#include "io/picture/result_file.h"
#include "tests/support/analytic.h"
#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

// Files of straight triangles keep the tolerance, or the program says that they do not: data/s1.obj
// against its closed form.

namespace halfshade {
namespace {

namespace fs = std::filesystem;

const std::string lamp_above_floor = test::data_file("s1.obj").string();
constexpr double reflectance = 0.5;  // of the receiver

/// What arrives straight from the light, which sends out 1 W/m²: the light is at z = 2, what hides
/// it of the receiver at z = 1.
double exact(const Vec3& p) {
  constexpr double light = 0.5, occluder = 0.375;
  if (p.z() > 1.5) return 0;
  const double height = 2 - p.z();
  const auto factor = [&](const Vec2& low, const Vec2& high) {
    return test::point_parallel_rectangle(low.x() - p.x(), high.x() - p.x(), low.y() - p.y(),
                                          high.y() - p.y(), height);
  };
  const Vec2 whole = Vec2::Constant(light);
  const double all = factor(-whole, whole);
  if (p.z() > 0.5) return all;
  const Vec2 shadow = Vec2::Constant(2 * occluder);
  const Vec2 low = (-shadow - p.head<2>()).cwiseMax(-whole);
  const Vec2 high = (shadow - p.head<2>()).cwiseMin(whole);
  return (low.array() < high.array()).all() ? all - factor(low, high) : all;
}

/// A triangle and what a file has at its corners.
struct Cell {
  std::array<Vec3, 3> corners;
  std::array<double, 3> value;
};

double area(const Cell& cell) {
  const auto& c = cell.corners;
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
}

/// Error of all cells in the L2 norm, by random points in each, relative to the norm of all light;
/// `times` the exact values they should have.
double true_error(const std::vector<Cell>& cells, double times) {
  test::Random random(61);
  double error = 0, norm = 0;
  const auto points = static_cast<int>(1 + 100'000 / cells.size());
  for (const Cell& cell : cells)
    for (int i = 0; i < points; ++i) {
      double s = random(0, 1), t = random(0, 1);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      const auto& c = cell.corners;
      const auto& v = cell.value;
      const double right = times * exact(c[0] + s * (c[1] - c[0]) + t * (c[2] - c[0]));
      const double weight = area(cell) / points;
      error += weight * std::pow(v[0] + s * (v[1] - v[0]) + t * (v[2] - v[0]) - right, 2);
      norm += weight * right * right;
    }
  return std::sqrt(error / norm);
}

const std::vector<double>& array_of(const std::vector<ResultArray>& arrays, const char* name) {
  return std::find_if(arrays.begin(), arrays.end(),
                      [&](const ResultArray& array) { return array.name == name; })
      ->values;
}

std::vector<Cell> cells_of(const ResultFile& file) {
  const std::vector<double>& light = array_of(file.point_arrays, "irradiance");
  std::vector<Cell> cells;
  for (const std::vector<int>& nodes : file.cells) {
    EXPECT_EQ(nodes.size(), 3u);
    Cell& cell = cells.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      cell.corners[k] = file.points[at(nodes[k])];
      cell.value[k] = light[3 * at(nodes[k])];
    }
  }
  return cells;
}

/// Those of the receiver, with radiosities.
std::vector<Cell> receiver_of_ply(const fs::path& path) {
  const std::string bytes = test::contents(path);
  const auto number = [&](const std::string& key) {
    return std::stoul(bytes.substr(bytes.find(key) + key.size()));
  };
  const std::size_t points = number("element vertex "), count = number("element face ");
  constexpr std::size_t point_size = 27, face_size = 13;
  const std::string end = "end_header\n";
  const std::size_t first = bytes.find(end) + end.size();
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::int32_t, 3> corner{};
    std::memcpy(corner.data(), &bytes[first + points * point_size + i * face_size + 1], 12);
    Cell cell;
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> place{};
      float radiosity = 0;
      const std::size_t begin = first + at(corner[k]) * point_size;
      std::memcpy(place.data(), &bytes[begin], 12);
      std::memcpy(&radiosity, &bytes[begin + 15], 4);
      cell.corners[k] = {place[0], place[1], place[2]};
      cell.value[k] = radiosity;
    }
    if (cell.corners[0].z() < 0.5) cells.push_back(cell);
  }
  return cells;
}

struct Solved {
  test::Outcome outcome;
  nlohmann::json report;
};

Solved solve_s1(const fs::path& folder, const std::string& output, const std::string& tolerance,
                const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {test::program, "solve",       lamp_above_floor, "--bounces",
                                    "0",           "--tolerance", tolerance,        "-o",
                                    output,        "-q",          "--json",         "r.json"};
  words.insert(words.end(), more.begin(), more.end());
  Solved run{test::run_program(words, folder), {}};
  run.report = nlohmann::json::parse(test::contents(folder / "r.json"));
  return run;
}

TEST(StraightFiles, KeepTheTolerance) {
  const test::TempDir folder;
  for (const std::string name : {"a.vtu", "a.vtp"})
    for (const std::string tolerance : {"1e-2", "1e-3", "1e-4"}) {
      const Solved run = solve_s1(folder.path(), name, tolerance, {"--linear"});
      EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.err;
      const ResultFile file = read_result(folder.path() / name);
      const std::vector<Cell> cells = cells_of(file);
      const double error = true_error(cells, 1);
      EXPECT_LE(error, std::stod(tolerance)) << name;
      EXPECT_LE(file.achieved_error, std::stod(tolerance));
      EXPECT_GE(file.achieved_error, 0.9 * error);
      EXPECT_LE(file.achieved_error, 2 * error);
      EXPECT_EQ(run.report["estimated_relative_error"], file.achieved_error);
      EXPECT_EQ(run.report["straight_triangles"]["triangles"], cells.size());
      EXPECT_EQ(run.report["accuracy_not_reached_because"], "");
      // What cells say, of the mean of three channels, makes up the whole.
      const std::vector<double>& off = array_of(file.cell_arrays, "error_estimate");
      double square = 0, norm = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        square += area(cells[i]) * 3 * std::pow(off[i], 2);
        norm += area(cells[i]) * 3 *
                std::pow((cells[i].value[0] + cells[i].value[1] + cells[i].value[2]) / 3, 2);
      }
      EXPECT_NEAR(std::sqrt(square / norm) / file.achieved_error, 1, 0.05) << name << tolerance;
    }
}

TEST(StraightFiles, KeepItAsPly) {
  const test::TempDir folder;
  const Solved run = solve_s1(folder.path(), "a.ply", "1e-4");
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.err;
  const std::vector<Cell> cells = receiver_of_ply(folder.path() / "a.ply");
  ASSERT_GT(cells.size(), 1000u);
  // The norm of all light is 1.774 times that of what arrives here.
  EXPECT_LE(true_error(cells, reflectance), 1.774e-4);
}

TEST(StraightFiles, SayWhereTheyCannotKeepIt) {
  const test::TempDir folder;
  const Solved run = solve_s1(folder.path(), "a.ply", "1e-7");
  EXPECT_EQ(run.outcome.exit_code, 4);
  EXPECT_NE(run.outcome.err.find("straight triangles"), std::string::npos) << run.outcome.err;
  EXPECT_EQ(std::count(run.outcome.err.begin(), run.outcome.err.end(), '\n'), 1);
  EXPECT_NE(run.report["accuracy_not_reached_because"], "");
  EXPECT_EQ(run.report["status"], "not_accurate");
  EXPECT_GT(run.report["estimated_relative_error"], 1e-6);
  EXPECT_LE(run.report["straight_triangles"]["triangles"], 2'000'000);
  // The polynomials can.
  EXPECT_EQ(solve_s1(folder.path(), "a.vtu", "1e-7").outcome.exit_code, 0);
}

TEST(StraightFiles, AreNoneWherePolynomialsAreWritten) {
  const test::TempDir folder;
  const Solved run = solve_s1(folder.path(), "a.vtu", "1e-3");
  EXPECT_FALSE(run.report.contains("straight_triangles"));
  const ResultFile file = read_result(folder.path() / "a.vtu");
  EXPECT_GT(*std::max_element(file.order.begin(), file.order.end()), 1);
  EXPECT_EQ(run.report["estimated_relative_error"], file.achieved_error);
}

}  // namespace
}  // namespace halfshade
