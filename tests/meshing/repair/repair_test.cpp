#include "meshing/repair/repair.h"

#include "meshing/core/error.h"
#include "meshing/patches/patch_mesh.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair_sentence.h"
#include "tests/support/cornell.h"
#include "tests/support/expect_error.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <random>

namespace halfshade {
namespace {

using test::add_material;
using test::add_polygon;
using test::contact_length;
using test::count;
using test::expect_sound;
using test::expect_surfaces_sound;
using test::only;
using test::rectangle;
using test::reversed;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MakeSound, RoomStaysAsItIs) {
  const Scene scene = test::room({3, 4, 2.5}, {});
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 6u);
  EXPECT_TRUE(sound.repairs.empty());
  expect_surfaces_sound(sound);
  for (std::size_t r = 0; r < 6; ++r) {
    const Surface& surface = sound.surfaces[r];
    EXPECT_THAT(surface.faces, ElementsAre(static_cast<int>(r)));
    EXPECT_TRUE(surface.contacts.empty());
    // Looks into the room, and its corners are the input's.
    EXPECT_GT(surface.frame.height({1.5, 2, 1.25}), 0);
    const std::vector<Vec3> corners = face_corners(scene, static_cast<int>(r));
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT((surface.frame.to_space(surface.rings[0][k]) - corners[k]).norm(), 1e-14);
  }
}

TEST(MakeSound, CornellBox) {
  const SoundScene sound = make_sound(test::cornell_box());
  expect_surfaces_sound(sound);
  EXPECT_EQ(sound.surfaces.size(), 17u);  // the red wall is 3.2 mm off plane: two triangles
  EXPECT_THAT(only(sound, Repair::Kind::non_planar_triangulated).faces, ElementsAre(5));
  EXPECT_THAT(sentence(only(sound, Repair::Kind::non_planar_triangulated), sound),
              HasSubstr("face 6"));
  EXPECT_THAT(only(sound, Repair::Kind::overlap_removed).faces, ElementsAre(1, 2));
  const Surface &light = sound.surfaces[1], &ceiling = sound.surfaces[2];
  EXPECT_DOUBLE_EQ(area(light), 130 * 105);
  EXPECT_DOUBLE_EQ(area(ceiling), 556 * 559.2 - 130 * 105);
  EXPECT_EQ(ceiling.rings.size(), 2u);
  EXPECT_EQ(light.plane, ceiling.plane);
  // The blocks stand on the floor: four edges each.
  const Surface& floor = sound.surfaces[0];
  EXPECT_EQ(floor.contacts.size(), 8u);
  EXPECT_NEAR(test::length_of(floor.contacts), contact_length(sound), 1e-9);
  double expected = 0;
  const std::vector<std::vector<Vec2>> blocks = {{{130, 65}, {82, 225}, {240, 272}, {290, 114}},
                                                 {{423, 247}, {265, 296}, {314, 456}, {472, 406}}};
  for (const auto& block : blocks) expected += test::perimeter_of({block});
  EXPECT_NEAR(contact_length(sound), expected, 1e-9);
}

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

TEST(MakeSound, TwoSidedFacesBecomeFrontAndBack) {
  const SoundScene sound =
      make_sound(scene_of({{rectangle(0, 0, 1, 2), 3}, {rectangle(0, 0, 1, 2, 5), 0}}));
  ASSERT_EQ(sound.surfaces.size(), 3u);
  const Surface &front = sound.surfaces[0], &back = sound.surfaces[1];
  EXPECT_FALSE(front.back);
  EXPECT_TRUE(back.back);
  EXPECT_EQ(front.plane, back.plane);
  EXPECT_LT((front.frame.normal + back.frame.normal).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(area(front), 2);
  EXPECT_DOUBLE_EQ(area(back), 2);
  expect_surfaces_sound(sound);
}

TEST(MakeSound, DropsFacesWithoutAreaAndRepeatedOnes) {
  Scene scene = scene_of({{rectangle(0, 0, 1, 1), 0},
                          {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 0},
                          {rectangle(0, 0, 1, 1e-12, 3), 0},
                          {{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1},
                          {{{1, 0, 4}, {1, 0, 4}, {1, 0, 4}}, 1}});
  scene.faces[3].line = 31;
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].material, 0);
  EXPECT_EQ(count(sound, Repair::Kind::degenerate_dropped), 3);
  EXPECT_THAT(only(sound, Repair::Kind::duplicate_dropped).faces, ElementsAre(3, 0));
  EXPECT_THAT(sentence(only(sound, Repair::Kind::duplicate_dropped), sound),
              testing::AllOf(HasSubstr("face 4 (line 31)"), HasSubstr("face 1")));
}

TEST(MakeSound, ARepeatedFaceThatEmitsIsTheOneThatStays) {
  const auto square = rectangle(0, 0, 1, 1);
  const SoundScene sound = make_sound(scene_of({{square, 0}, {square, 2}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].material, 2);
}

TEST(MakeSound, RepeatedCornersAndSpikesBoundNothing) {
  const SoundScene sound = make_sound(scene_of(
      {{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}},
        0},
       {{{3, 0, 0}, {6, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}}, 0}}));
  ASSERT_EQ(sound.surfaces.size(), 2u);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[0]), 1);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[1]), 1);
}

TEST(MakeSound, AHoleCutInByABridgeBecomesAHole) {
  const SoundScene sound = make_sound(scene_of({{{{0, 0, 0},
                                                  {3, 0, 0},
                                                  {3, 3, 0},
                                                  {0, 3, 0},
                                                  {0, 0, 0},
                                                  {1, 1, 0},
                                                  {1, 2, 0},
                                                  {2, 2, 0},
                                                  {2, 1, 0},
                                                  {1, 1, 0}},
                                                 0}}));
  ASSERT_EQ(sound.surfaces.size(), 1u);
  EXPECT_EQ(sound.surfaces[0].rings.size(), 2u);
  EXPECT_DOUBLE_EQ(total_area(sound), 8);
}

TEST(MakeSound, FacesThatCrossThemselvesAreNamed) {
  const std::vector<std::vector<Vec3>> crossed = {
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},                // bow tie, areas cancel
      {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}},                // bow tie, areas differ
      {{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}}  // pentagram
  };
  for (const auto& polygon : crossed)
    test::expect_error(
        [&] {
          make_sound(scene_of({{rectangle(5, 5, 6, 6, 1), 0}, {polygon, 0}}));
        },
        ErrorCode::invalid_input, {"test.obj", "face 2", "crosses itself"});
}

TEST(MakeSound, NothingWithAnAreaIsAnError) {
  test::expect_error(
      [] {
        make_sound(scene_of({{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0}}));
      },
      ErrorCode::invalid_input, {"test.obj", "area"});
}

// What a scene is must not depend on where it lies, how large it is or how its faces are ordered.
struct Numbers {
  std::size_t surfaces, contacts, repairs;
  double area, contact_length;
};

Numbers numbers(const SoundScene& scene) {
  Numbers result{scene.surfaces.size(), 0, scene.repairs.size(), total_area(scene),
                 contact_length(scene)};
  for (const Surface& surface : scene.surfaces) result.contacts += surface.contacts.size();
  return result;
}

void expect_same(const Numbers& a, const Numbers& b, double scale) {
  EXPECT_EQ(a.surfaces, b.surfaces);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.repairs, b.repairs);
  EXPECT_NEAR(a.area * scale * scale / b.area, 1, 1e-9);
  EXPECT_NEAR(a.contact_length * scale / b.contact_length, 1, 1e-9);
}

class Moved : public testing::TestWithParam<int> {};

TEST_P(Moved, SceneIsTheSame) {
  const int seed = GetParam();
  const Scene scene = test::cornell_box();
  const Numbers expected = numbers(make_sound(scene));
  const Vec3 axis = Vec3(1 + seed, 2 - seed, 0.5 * seed).normalized();
  const Eigen::AngleAxisd turn(0.7 + seed, axis);
  const double scale = std::pow(10.0, 6 * seed - 12);
  Scene moved = scene;
  for (Vec3& p : moved.vertices) p = scale * (turn * p + Vec3(1000, -200 * seed, 30));
  std::rotate(moved.faces.begin(), moved.faces.begin() + 3 * seed, moved.faces.end());
  const SoundScene sound = make_sound(moved);
  expect_same(expected, numbers(sound), scale);
  expect_surfaces_sound(sound);
}

INSTANTIATE_TEST_SUITE_P(Motions, Moved, testing::Range(0, 5));

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
