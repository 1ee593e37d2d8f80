#include "io/picture/result_file.h"
#include "io/read/read_scene.h"
#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// A cube whose face at x = 0 shines, with a wall through it at x = 0.6 that no light gets past.
Scene parted_cube() {
  Scene scene = test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
  const int material = test::add_material(scene, 0.5, 0);
  std::vector<Vec3> wall = {{0.6, 0, 0}, {0.6, 1, 0}, {0.6, 1, 1}, {0.6, 0, 1}};
  test::add_polygon(scene, wall, material);
  std::reverse(wall.begin(), wall.end());
  test::add_polygon(scene, wall, material);
  return scene;
}

/// The largest step between values that triangles have in the same point, of the largest value.
/// Points of different planes are told apart by the triangle's normal.
double largest_step(const ShadedMesh& mesh) {
  std::map<std::array<double, 6>, std::pair<double, double>> range;
  double largest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.emits[t] != 0) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    Vec3 normal = (mesh.points[at(b)] - mesh.points[at(a)])
                      .cross(mesh.points[at(c)] - mesh.points[at(a)])
                      .normalized();
    for (double& x : normal) x = std::round(1e6 * x);
    for (const int k : {a, b, c}) {
      const Vec3& p = mesh.points[at(k)];
      const double value = mesh.point_value[at(k)][1];
      const auto [entry, is_new] = range.try_emplace(
          {p.x(), p.y(), p.z(), normal.x(), normal.y(), normal.z()}, value, value);
      entry->second.first = std::min(entry->second.first, value);
      entry->second.second = std::max(entry->second.second, value);
      largest = std::max(largest, value);
    }
  }
  double step = 0;
  for (const auto& [place, values] : range) step = std::max(step, values.second - values.first);
  return step / largest;
}

TEST(JoinedPicture, LightHasNoStepsButFalseColoursAreAsSolved) {
  SolveOptions options;
  options.tolerance = 0.05;
  const SolveResult result = solve(read_scene(test::data_file("s1.obj")).scene, options);
  EXPECT_LT(largest_step(shaded(result)), 1e-3);
  const test::TempDir folder;
  write_result(result, {}, folder.path() / "a.vtu");
  const ResultFile file = read_result(folder.path() / "a.vtu");
  EXPECT_LT(largest_step(shaded(file)), 1e-3);
  EXPECT_GT(largest_step(quantity_of(file, "radiosity").mesh), 0.01);
}

TEST(JoinedPicture, NoLightLeaksUnderAWall) {
  SolveOptions options;
  options.tolerance = 0.05;
  options.radiosity.bounces = 0;
  const SolveResult result = solve(parted_cube(), options);
  const test::TempDir folder;
  write_result(result, {}, folder.path() / "a.vtu");
  for (const ShadedMesh& mesh : {shaded(result), read_shaded(folder.path() / "a.vtu")}) {
    double dark = 0, lit = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int k : mesh.triangles[t]) {
        const Vec3& p = mesh.points[at(k)];
        const auto& [a, b, c] = mesh.triangles[t];
        const double x = (mesh.points[at(a)] + mesh.points[at(b)] + mesh.points[at(c)]).x() / 3;
        if (x > 0.6) dark = std::max(dark, mesh.point_value[at(k)].maxCoeff());
        if (x < 0.6 && p.x() == 0.6) lit = std::max(lit, mesh.point_value[at(k)].maxCoeff());
      }
    EXPECT_EQ(dark, 0);
    EXPECT_GT(lit, 0.01);
  }
}

}  // namespace
}  // namespace halfshade
