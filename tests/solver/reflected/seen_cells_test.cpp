#include "solver/reflected/seen_cells.h"

#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace halfshade {
namespace {

std::set<int> cells_before(const ReflectingScene& scene) {
  std::set<int> cells;
  for (int r = 0; r < scene.roots.count(); ++r) cells.insert(scene.cells.before(r));
  return cells;
}

/// Says of the first wall's roots that they look into another cell, closed or not.
void set_apart(ReflectingScene& scene, bool is_closed) {
  const int cell = scene.cells.count();
  scene.cells.closed.push_back(is_closed);
  scene.cells.gaps.push_back(0);
  scene.cells.swallowing.push_back(-1);
  for (int r = 0; r < scene.roots.count(); ++r)
    if (scene.roots.surface[at(r)] == 0) scene.cells.of_side[at(r)][0] = cell;
}

TEST(SeenCells, AreOneIfLightGetsBetweenThem) {
  for (const bool is_closed : {true, false}) {
    ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
    const int before = scene.cells.count();
    set_apart(scene, is_closed);
    ASSERT_EQ(cells_before(scene).size(), 2u);
    join_seen_cells(scene);
    EXPECT_EQ(scene.cells.count(), before);
    ASSERT_EQ(cells_before(scene).size(), 1u);
    EXPECT_EQ(scene.cells.closed[at(*cells_before(scene).begin())], is_closed);
  }
}

TEST(SeenCells, StayApartWithAWallBetween) {
  Scene scene = test::room({1, 1, 1}, {});
  for (const auto& face : test::box_faces({1, 0, 0}, {2, 1, 1}, true))
    test::add_polygon(scene, face, 0);
  const ReflectingScene reflecting = make_reflecting_scene(make_sound(scene));
  const std::set<int> cells = cells_before(reflecting);
  EXPECT_EQ(cells.size(), 2u);
  for (const int cell : cells) EXPECT_TRUE(reflecting.cells.closed[at(cell)]);
}

TEST(SeenCells, OfFewDigitsAreWhatTheyAreOfMany) {
  // A room of 4 × 3 × 2.5 m, in inches, with a wall of two pieces across that leaves a slit.
  Scene scene = test::room({4, 3, 2.5}, {});
  for (const auto& [low, high] : {std::pair(Vec3(2, 0, 0), Vec3(2.1, 2.2, 2.5)),
                                  std::pair(Vec3(2, 2.2, 0), Vec3(2.1, 2.95, 2.5))})
    for (const auto& face : test::box_faces(low, high, false)) test::add_polygon(scene, face, 0);
  // Without rays some five of these come out as several cells.
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::AngleAxisd turn(0.4 + trial, Vec3(1 + trial, 2, 3 - trial).normalized());
    Scene rounded = scene;
    for (Vec3& p : rounded.vertices) {
      p = turn * (39.3701 * p);
      for (double& x : p) x = std::stod(fmt::format("{:.5g}", x));
    }
    const ReflectingScene reflecting = make_reflecting_scene(make_sound(rounded));
    // Pieces of walls that others cover may look anywhere; all that look into the room, into one.
    std::set<int> cells;
    for (int r = 0; r < reflecting.roots.count(); ++r) {
      const auto [a, b, c] = reflecting.roots.triangle(r);
      const Vec3 before =
          turn.inverse() * Vec3((a + b + c) / 3 + 0.8 * reflecting.roots.normal[at(r)]) / 39.3701;
      const bool is_in_wall = before.x() > 2 && before.x() < 2.1 && before.y() < 2.95;
      const bool is_in_room = before.x() > 0 && before.x() < 4 && before.y() > 0 &&
                              before.y() < 3 && before.z() > 0 && before.z() < 2.5;
      if (reflecting.roots.area[at(r)] > 10 && is_in_room && !is_in_wall)
        cells.insert(reflecting.cells.before(r));
    }
    EXPECT_EQ(cells.size(), 1u) << "trial " << trial;
  }
}

}  // namespace
}  // namespace halfshade
