#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>

#include <array>
#include <gmock/gmock.h>
#include <random>
#include <utility>
#include <vector>

// Who keeps what several faces of one plane cover.

namespace halfshade {
namespace {

using test::add_polygon;
using test::count;
using test::expect_sound;
using test::expect_surfaces_sound;
using test::only;
using test::rectangle;
using test::reversed;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;

TEST(MakeSound, OverlapGoesToTheEmitterElseToTheSmallerFace) {
  const auto wall = rectangle(0, 0, 4, 4), picture = rectangle(1, 1, 2, 2);
  const SoundScene smaller = make_sound(scene_of({{wall, 0}, {picture, 1}}));
  ASSERT_EQ(smaller.surfaces.size(), 2u);
  EXPECT_DOUBLE_EQ(area(smaller.surfaces[0]), 15);
  EXPECT_DOUBLE_EQ(area(smaller.surfaces[1]), 1);
  const SoundScene lamp = make_sound(scene_of({{wall, 2}, {picture, 1}}));
  ASSERT_EQ(lamp.surfaces.size(), 1u);
  EXPECT_DOUBLE_EQ(area(lamp.surfaces[0]), 16);
  EXPECT_THAT(only(lamp, Repair::Kind::overlap_removed).faces, ElementsAre(0, 1));
}

TEST(MakeSound, PartialOverlapIsCutAtTheCrossings) {
  const SoundScene sound =
      make_sound(scene_of({{rectangle(0, 0, 4, 4), 0}, {rectangle(3, 3, 5, 4.5), 1}}));
  ASSERT_EQ(sound.surfaces.size(), 2u);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[0]), 15);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[1]), 3);
  EXPECT_EQ(sound.surfaces[0].rings[0].size(), 6u);
}

TEST(MakeSound, OverlapOfOneMaterialIsAUnion) {
  const SoundScene sound =
      make_sound(scene_of({{rectangle(0, 0, 2, 2), 0}, {rectangle(1, 1, 3, 3), 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_DOUBLE_EQ(total_area(sound), 7);
  EXPECT_EQ(count(sound, Repair::Kind::overlap_removed), 0);
}

TEST(MakeSound, FacesThatLookOppositeWaysDoNotOverlap) {
  const auto square = rectangle(0, 0, 1, 1);
  const SoundScene sound = make_sound(scene_of({{square, 0}, {reversed(square), 1}}));
  ASSERT_EQ(sound.surfaces.size(), 2u);
  EXPECT_EQ(sound.surfaces[0].plane, sound.surfaces[1].plane);
  EXPECT_NEAR(sound.surfaces[0].frame.normal.dot(sound.surfaces[1].frame.normal), -1, 1e-15);
  EXPECT_TRUE(sound.repairs.empty());
}

// Rectangles on a grid of unit cells, turned in space: which of them owns a cell can be told by
// looking at the cell.
TEST(MakeSound, RandomOverlapsGiveEachMaterialItsCells) {
  std::mt19937 random(3);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int trial = 0; trial < 40; ++trial) {
    struct Rectangle {
      int x0, y0, x1, y1, material;
    };
    std::vector<Rectangle> rectangles;
    Scene scene = scene_of({});
    const Eigen::AngleAxisd turn(0.1 + trial, Vec3(1, trial, 2).normalized());
    for (int k = 0; k < 4 + trial / 2; ++k) {
      Rectangle r{below(9), below(9), 0, 0, below(3)};
      r.x1 = r.x0 + 1 + below(4);
      r.y1 = r.y0 + 1 + below(4);
      rectangles.push_back(r);
      auto corners = rectangle(r.x0, r.y0, r.x1, r.y1);
      for (Vec3& p : corners) p = turn * p;
      add_polygon(scene, corners, r.material);
    }
    std::array<int, 3> cells{};
    for (int x = 0; x < 13; ++x)
      for (int y = 0; y < 13; ++y) {
        const Rectangle* owner = nullptr;
        const auto rank = [](const Rectangle& r) {
          return std::pair(r.material != 2, (r.x1 - r.x0) * (r.y1 - r.y0));
        };
        for (const Rectangle& r : rectangles)
          if (x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1 && (!owner || rank(r) < rank(*owner)))
            owner = &r;
        if (owner) ++cells[static_cast<std::size_t>(owner->material)];
      }
    const SoundScene sound = make_sound(scene);
    expect_surfaces_sound(sound);
    std::array<double, 3> area_of{};
    for (const Surface& r : sound.surfaces)
      area_of[static_cast<std::size_t>(r.material)] += area(r);
    // Equal areas are ranked by rounding once turned, so only their sum is certain then.
    EXPECT_NEAR(area_of[2], cells[2], 1e-9);
    EXPECT_NEAR(area_of[0] + area_of[1], cells[0] + cells[1], 1e-9);
    expect_sound(PatchMesh(sound, {.max_length = 1.5}).elements(), sound);
  }
}

}  // namespace
}  // namespace halfshade
