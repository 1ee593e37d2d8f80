#include "meshing/patches/shared_edges.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair.h"
#include "tests/support/cornell.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace halfshade {
namespace {

using test::add_material;
using test::add_polygon;
using test::expect_alike_across_surfaces;
using test::expect_sound;

void add_box(Scene& scene, const Vec3& low, const Vec3& high, bool inwards = false) {
  const int material = add_material(scene, 0.5, 0);
  for (const auto& face : test::box_faces(low, high, inwards)) add_polygon(scene, face, material);
}

// A room with two boxes on its floor, one of which touches a wall and the other two walls.
Scene room_with_boxes() {
  Scene scene;
  add_box(scene, {0, 0, 0}, {4, 3, 2.5}, true);
  add_box(scene, {1, 0, 0}, {1.7, 0.6, 0.8});
  add_box(scene, {3.1, 2.2, 0}, {4, 3, 1.1});
  return scene;
}

// Boxes of different sizes on top of and beside each other: edges end in the middle of edges.
Scene stack() {
  Scene scene;
  add_box(scene, {0, 0, 0}, {2, 2, 1});
  add_box(scene, {0, 0, 1}, {1.3, 0.9, 1.7});
  add_box(scene, {1.3, 0, 1}, {2, 0.7, 1.4});
  add_box(scene, {2, 0, 0}, {2.6, 2, 0.5});
  add_box(scene, {0, 0.9, 1}, {0.45, 2, 1.2});
  return scene;
}

// A two-sided sheet that stands on a floor and leans on a wall.
Scene sheets() {
  Scene scene;
  const int grey = add_material(scene, 0.5, 0), sheet = add_material(scene, 0.5, 0);
  scene.materials[static_cast<std::size_t>(sheet)].two_sided = true;
  add_polygon(scene, {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}, grey);
  add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {0, 3, 2}, {0, 0, 2}}, grey);
  add_polygon(scene, {{0, 1, 0}, {2, 1, 0}, {2, 1, 1}, {0, 1, 1}}, sheet);
  add_polygon(scene, {{2, 1, 0}, {2, 2.2, 0}, {2, 2.2, 0.6}, {2, 1, 0.6}}, sheet);
  return scene;
}

// Five polygons that meet in one edge, not all in its whole length.
Scene book() {
  Scene scene;
  const int material = add_material(scene, 0.5, 0);
  for (int page = 0; page < 5; ++page) {
    const double angle = 0.3 + 1.1 * page, top = page % 2 == 0 ? 2 : 1.2 + 0.2 * page;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), up(0, 0, top);
    add_polygon(scene, {Vec3::Zero(), out, out + up, up}, material);
  }
  return scene;
}

Scene turned(Scene scene) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : scene.vertices) p = turn * p + Vec3(3, -1, 7);
  return scene;
}

struct Named {
  std::string name;
  Scene scene;
};

std::vector<Named> scenes() {
  return {{"room", room_with_boxes()},
          {"stack", stack()},
          {"sheets", sheets()},
          {"book", book()},
          {"L-room", test::l_room(true)},
          {"turned stack", turned(stack())},
          {"turned room", turned(room_with_boxes())},
          {"turned book", turned(book())},
          {"Cornell", test::cornell_box()}};
}

TEST(SharedEdges, PlainMeshesAreAlikeOnBothSides) {
  for (const auto& [name, input] : scenes()) {
    SCOPED_TRACE(name);
    const SoundScene scene = make_sound(input);
    for (const int elements : {1, 600, 4000}) {
      const PatchMesh mesh(scene, {.max_length = length_for_count(scene, elements)});
      const ElementTable table = mesh.elements();
      expect_sound(table, scene);
      EXPECT_GT(expect_alike_across_surfaces(table, scene), 0);
    }
  }
}

TEST(SharedEdges, ScenesWithShadowsOfEveryKindAreAlike) {
  for (const auto& scenes : {test::degenerate_scenes(), test::discontinuity_scenes()})
    for (const auto& [name, scene] : scenes) {
      SCOPED_TRACE(name);
      PatchMesh mesh(scene, {.max_length = length_for_count(scene, 500)});
      for (int round = 0; round < 2; ++round) {
        expect_sound(mesh.elements(), scene);
        expect_alike_across_surfaces(mesh.elements(), scene);
        mesh.split_in_four(std::vector<int>{0, 3, mesh.element_count() - 1});
      }
    }
}

// Coordinates with six digits: polygons are off their planes, and neighbours off each other, by
// more than the tolerance of points.
TEST(SharedEdges, PolygonsOffTheirPlanesAreAlike) {
  for (Scene input : {turned(stack()), turned(room_with_boxes()), turned(book())}) {
    for (Vec3& p : input.vertices) p = (1e6 * p).array().round() * 1e-6;
    const SoundScene scene = make_sound(input);
    PatchMesh mesh(scene, {.max_length = length_for_count(scene, 400)});
    for (int round = 0; round < 3; ++round) {
      const ElementTable table = mesh.elements();
      EXPECT_GT(expect_alike_across_surfaces(table, scene, 3e-6), 50);
      double area = 0, whole = 0;
      for (const double a : table.area) area += a;
      for (const Surface& surface : scene.surfaces) whole += test::area_of(surface.rings);
      EXPECT_NEAR(area / whole, 1, 1e-6);
      mesh.split_in_four(std::vector<int>{0, 50, 100, 150});
    }
  }
}

TEST(SharedEdges, WallsAHairApartAreNotJoined) {
  // Two floors with a gap between them, and a box that does not quite touch a wall; the planes of
  // box and wall must be farther apart than what counts as one.
  for (const auto& [gap, box_gap] : {std::pair(5e-9, 1e-5), {1e-7, 1e-4}, {1e-5, 1e-3}}) {
    Scene input;
    const int grey = add_material(input, 0.5, 0);
    add_polygon(input, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, grey);
    add_polygon(input, {{1 + gap, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1 + gap, 1, 0}},
                add_material(input, 0.4, 0));
    add_box(input, {box_gap, 0.3, 0}, {0.4, 0.7, 0.5});
    add_polygon(input, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, grey);
    const SoundScene scene = make_sound(input);
    const ElementTable table = PatchMesh(scene, {.max_length = 0.3}).elements();
    expect_sound(table, scene);
    EXPECT_GT(expect_alike_across_surfaces(table, scene), 0);
  }
}

TEST(SharedEdges, SameForAnyNumberOfThreads) {
  const SoundScene scene = make_sound(room_with_boxes());
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    PatchMesh mesh(scene, {.max_length = 0.2});
    mesh.bisect(std::vector<int>{0, 100, 1000});
    return mesh.elements();
  };
  const ElementTable one = run(1), two = run(2);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.corners, two.corners);
  EXPECT_EQ(one.edge_order, two.edge_order);
}

TEST(SharedEdges, QualityDoesNotSufferFromNeighbours) {
  for (const Scene& input : {room_with_boxes(), stack(), turned(stack()), book()}) {
    const SoundScene scene = make_sound(input);
    const PatchMesh mesh(scene, {.max_length = length_for_count(scene, 2000)});
    EXPECT_GE(summarize_quality(mesh.elements()).min_angle, 20.7);
  }
}

TEST(SharedEdges, StayAlikeUnderRandomSplits) {
  for (const auto& [name, input] : scenes()) {
    SCOPED_TRACE(name);
    const SoundScene scene = make_sound(input);
    PatchMesh mesh(scene, {.max_length = length_for_count(scene, 200)});
    const double angle = summarize_quality(mesh.elements()).min_angle;
    std::mt19937 random(5);
    for (int round = 0; round < 6; ++round) {
      std::vector<int> chosen;
      for (int k = 0; k < 12; ++k)
        chosen.push_back(static_cast<int>(random() % static_cast<unsigned>(mesh.element_count())));
      round % 2 == 0 ? mesh.split_in_four(chosen) : mesh.bisect(chosen);
      const ElementTable table = mesh.elements();
      expect_sound(table, scene);
      expect_alike_across_surfaces(table, scene);
    }
    EXPECT_GE(summarize_quality(mesh.elements()).min_angle, angle / 2 - 1e-9);
  }
}

TEST(SharedEdges, SplittingTowardsASharedEdgeStaysLocal) {
  const SoundScene scene = make_sound(room_with_boxes());
  PatchMesh mesh(scene, {.max_length = 0.4});
  const int before = mesh.element_count();
  for (int round = 0; round < 12; ++round) {
    const ElementTable table = mesh.elements();
    std::vector<int> chosen;
    for (int e = 0; e < table.count(); ++e)
      for (const Vec3& p : table.triangle(e))
        if ((p - Vec3(1, 0, 0)).norm() < 1e-9) chosen.push_back(e);
    mesh.split_in_four(chosen);
  }
  const ElementTable table = mesh.elements();
  expect_sound(table, scene);
  expect_alike_across_surfaces(table, scene);
  EXPECT_LT(mesh.element_count(), before + 12 * 400);
}

TEST(SharedEdges, EdgeOrderIsZeroOnBordersAndContactLinesOnly) {
  for (const auto& [name, input] : scenes()) {
    SCOPED_TRACE(name);
    const SoundScene scene = make_sound(input);
    PatchMesh mesh(scene, {.max_length = length_for_count(scene, 300)});
    mesh.split_in_four(std::vector<int>{0, 10, 20});
    const ElementTable table = mesh.elements();
    ASSERT_EQ(table.edge_order.size(), table.corners.size());
    for (std::size_t e = 0; e < table.corners.size(); ++e)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(table.edge_order[e][k], table.neighbours[e][k] < 0 ? 0 : -1);
  }
}

}  // namespace
}  // namespace halfshade
