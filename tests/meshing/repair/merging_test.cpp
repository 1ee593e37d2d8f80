#include "meshing/patches/patch_mesh.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair.h"
#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <gmock/gmock.h>

// Neighbours of one plane, material, group and side become one surface.

namespace halfshade {
namespace {

using test::add_material;
using test::add_polygon;
using test::count;
using test::expect_surfaces_sound;
using test::rectangle;
using test::reversed;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;

TEST(MakeSound, TriangleSoupOfACubeGivesSixSurfaces) {
  Scene scene;
  add_material(scene, 0.5, 1);
  for (const auto& face : test::box_faces({0, 0, 0}, {1, 2, 3}, false)) {
    add_polygon(scene, {face[0], face[1], face[2]}, 0);
    add_polygon(scene, {face[0], face[2], face[3]}, 0);
  }
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 6u);
  expect_surfaces_sound(sound);
  EXPECT_EQ(count(sound, Repair::Kind::coplanar_merged), 6);
  for (const Surface& surface : sound.surfaces) {
    EXPECT_EQ(surface.rings.size(), 1u);
    EXPECT_EQ(surface.rings[0].size(), 4u);
    EXPECT_EQ(surface.faces.size(), 2u);
  }
  EXPECT_NEAR(total_area(sound), 2 * (2 + 3 + 6), 1e-12);
}

TEST(MakeSound, NeighboursWithTJunctionsMerge) {
  const SoundScene sound = make_sound(scene_of(
      {{rectangle(0, 0, 2, 1), 0}, {rectangle(0, 1, 0.7, 2), 0}, {rectangle(0.7, 1, 2, 2), 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings[0].size(), 4u);
  EXPECT_THAT(sound.surfaces[0].faces, ElementsAre(0, 1, 2));
  EXPECT_DOUBLE_EQ(total_area(sound), 4);
}

TEST(MakeSound, FacesRoundAHoleMergeIntoAPolygonWithAHole) {
  const SoundScene sound = make_sound(scene_of({{rectangle(0, 0, 3, 1), 0},
                                                {rectangle(0, 2, 3, 3), 0},
                                                {rectangle(0, 1, 1, 2), 0},
                                                {rectangle(2, 1, 3, 2), 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  ASSERT_EQ(sound.surfaces[0].rings.size(), 2u);
  EXPECT_EQ(sound.surfaces[0].rings[0].size(), 4u);
  EXPECT_EQ(sound.surfaces[0].rings[1].size(), 4u);
  EXPECT_DOUBLE_EQ(total_area(sound), 8);
  expect_surfaces_sound(sound);
}

TEST(MakeSound, FacesThatTouchInACornerStaySeparate) {
  EXPECT_EQ(make_sound(scene_of({{rectangle(0, 0, 1, 1), 0}, {rectangle(1, 1, 2, 2), 0}}))
                .surfaces.size(),
            2u);
}

TEST(MakeSound, MaterialsGroupsAndSidesKeepNeighboursApart) {
  Scene scene = scene_of({{rectangle(0, 0, 1, 1), 0},
                          {rectangle(1, 0, 2, 1), 1},
                          {rectangle(2, 0, 3, 1), 1},
                          {reversed(rectangle(3, 0, 4, 1)), 1}});
  scene.groups.emplace_back("other");
  scene.faces[2].group = 1;
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 4u);
  EXPECT_EQ(sound.surfaces[2].group, 1);
  for (const Surface& surface : sound.surfaces) EXPECT_EQ(surface.plane, sound.surfaces[0].plane);
  EXPECT_TRUE(sound.repairs.empty());
}

TEST(MakeSound, ARingThatClosesOnACornerIsOneSurfaceWithAHole) {
  // Eight unit squares round an empty one, and a notch that meets the hole in the corner (1,1).
  std::vector<std::pair<std::vector<Vec3>, int>> faces;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if ((i != 1 || j != 1) && (i != 0 || j != 0))
        faces.emplace_back(rectangle(i, j, i + 1, j + 1), 0);
  const SoundScene sound = make_sound(scene_of(faces));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings.size(), 2u);
  EXPECT_DOUBLE_EQ(total_area(sound), 7);
  expect_surfaces_sound(sound);
}

TEST(MakeSound, TurnedTessellationsMergeWithoutGaps) {
  // A wall of 12 × 12 squares with every third column shifted, so that rows meet in T-junctions.
  const Eigen::AngleAxisd turn(0.9, Vec3(1, 2, 3).normalized());
  Scene scene = scene_of({});
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) {
      const double shift = j == 0 || i % 3 != 0 ? 0 : 0.3, top = i % 3 == 0 && j < 11 ? 0.3 : 0;
      auto corners = rectangle(i, j + shift, i + 1, j + 1 + top);
      for (Vec3& p : corners) p = turn * p;
      add_polygon(scene, corners, 0);
    }
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings[0].size(), 4u);
  EXPECT_NEAR(total_area(sound), 144, 1e-9);
}

TEST(MakeSound, DecimalRoundingOfTurnedTessellationsLeavesNoGaps) {
  // As a file with six decimals has it: T-vertices lie off their edges by up to 1e-6.
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::AngleAxisd turn(0.3 + trial, Vec3(1, trial, 3).normalized());
    Scene scene = scene_of({});
    for (int row = 0; row < 10; ++row)
      for (int k = 0; k <= row + trial; ++k) {
        const double n = row + trial + 1;
        auto corners = rectangle(k / n, 0.1 * row, (k + 1) / n, 0.1 * (row + 1));
        for (Vec3& p : corners)
          for (double& x : p = turn * p) x = std::round(1e6 * x) / 1e6;
        add_polygon(scene, corners, 0);
      }
    const SoundScene sound = make_sound(scene);
    ASSERT_EQ(sound.surfaces.size(), 1u);
    EXPECT_EQ(sound.surfaces[0].rings.size(), 1u);
    EXPECT_NEAR(total_area(sound), 1, 1e-5);
    EXPECT_GE(summarize_quality(PatchMesh(sound, {.max_length = 0.1}).elements()).min_angle, 20.7);
  }
}

TEST(MakeSound, NearbyVerticesAreWelded) {
  const SoundScene sound =
      make_sound(scene_of({{rectangle(0, 0, 1, 1), 0},
                           {{{1 + 2e-10, 3e-10, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 1e-10}}, 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings[0].size(), 4u);
  EXPECT_DOUBLE_EQ(total_area(sound), 2);
}

TEST(MakeSound, CurvedSurfacesStayApart) {
  // A faceted cylinder: neighbours bend by 3.6 degrees.
  Scene scene = scene_of({});
  for (int k = 0; k < 100; ++k) {
    const double a = 2 * M_PI * k / 100, b = 2 * M_PI * (k + 1) / 100;
    add_polygon(scene,
                {{std::cos(a), std::sin(a), 0},
                 {std::cos(b), std::sin(b), 0},
                 {std::cos(b), std::sin(b), 1},
                 {std::cos(a), std::sin(a), 1}},
                0);
  }
  const SoundScene sound = make_sound(scene);
  EXPECT_EQ(sound.surfaces.size(), 100u);
  EXPECT_NEAR(total_area(sound), 200 * std::sin(M_PI / 100), 1e-9);
}

}  // namespace
}  // namespace halfshade
