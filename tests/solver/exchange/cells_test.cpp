#include "solver/exchange/cells.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/own_corners.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace halfshade {
namespace {

struct Parted {
  SoundScene scene;
  ElementTable elements;
  SpaceCells cells;

  explicit Parted(const Scene& input, double max_length = 0.4) : scene(make_sound(input)) {
    PlanarMeshOptions options;
    options.max_length = max_length;
    elements = PatchMesh(scene, options).elements();
    cells = find_cells(scene, elements);
  }

  /// The cells before all elements of a group of input faces.
  std::set<int> before(int first_face, int end_face) const {
    std::set<int> result;
    for (int e = 0; e < elements.count(); ++e)
      if (elements.face[at(e)] >= first_face && elements.face[at(e)] < end_face)
        result.insert(cells.before(e));
    return result;
  }

  /// Whether all these faces look into one closed cell.
  bool are_closed(int first_face, int end_face) const {
    const std::set<int> result = before(first_face, end_face);
    return result.size() == 1 && cells.closed[at(*result.begin())];
  }
};

void add_box(Scene& scene, const Vec3& low, const Vec3& high, bool inwards) {
  for (const auto& face : test::box_faces(low, high, inwards))
    test::add_polygon(scene, face, test::add_material(scene, 0.5, 0));
}

Scene box(bool inwards) {
  Scene scene;
  add_box(scene, Vec3::Zero(), Vec3::Ones(), inwards);
  return scene;
}

TEST(Cells, ARoomIsClosedAndABodyIsNot) {
  const Parted room(box(true)), body(box(false));
  EXPECT_EQ(room.cells.count(), 2);
  EXPECT_TRUE(room.are_closed(0, 6));
  EXPECT_FALSE(body.are_closed(0, 6));
  EXPECT_EQ(body.cells.swallowing[at(body.cells.before(0))], -1) << "light goes to infinity";
}

TEST(Cells, AnyGapOpensARoom) {
  for (const double gap : {1e-3, 1e-5, 3e-6}) {
    Scene scene = box(true);
    for (const int v : scene.faces[5].vertices) scene.vertices[at(v)].z() += gap;
    const Parted room(scene);
    EXPECT_EQ(room.before(0, 6).size(), 1u);
    EXPECT_FALSE(room.cells.closed[at(room.cells.before(0))]) << gap;
  }
  Scene missing = box(true);
  missing.faces.pop_back();
  EXPECT_FALSE(Parted(missing).are_closed(0, 5));
}

TEST(Cells, ParallelPlatesAreOpenHoweverNear) {
  for (const double gap : {1e-3, 1e-4, 1e-6}) {
    Scene scene;
    const int material = test::add_material(scene, 0.999, 1);
    test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, material);
    test::add_polygon(scene, {{0, 1, gap}, {1, 1, gap}, {1, 0, gap}, {0, 0, gap}}, material);
    EXPECT_FALSE(Parted(scene).are_closed(0, 2)) << gap;
  }
}

TEST(Cells, ABackSwallowsLight) {
  Scene turned = box(true);
  std::reverse(turned.faces[5].vertices.begin(), turned.faces[5].vertices.end());
  const Parted room(turned);
  EXPECT_FALSE(room.are_closed(0, 5));
  EXPECT_EQ(room.cells.swallowing[at(room.cells.before(0))], 5);
  Scene sheet = box(true);
  const int material = test::add_material(sheet, 0.5, 0);
  test::add_polygon(sheet, {{.2, .3, .4}, {.7, .3, .5}, {.7, .8, .5}, {.2, .8, .4}}, material);
  EXPECT_FALSE(Parted(sheet).are_closed(0, 7));
  sheet.materials[at(material)].two_sided = true;
  EXPECT_TRUE(Parted(sheet).are_closed(0, 7));
}

TEST(Cells, BodiesBelongToTheRoomTheyAreIn) {
  Scene scene = box(true);
  add_box(scene, {.2, .2, .3}, {.5, .5, .6}, false);  // hangs
  add_box(scene, {.6, .6, 0}, {.8, .8, .5}, false);   // stands
  add_box(scene, {.6, .2, .5}, {.8, .3, 1}, false);   // hangs from the ceiling
  const Parted room(scene, 0.3);
  const int inside = room.cells.before(0);
  EXPECT_TRUE(room.cells.closed[at(inside)]);
  EXPECT_EQ(room.before(6, 12), std::set<int>{inside});
  // The floor under the box that stands looks into it.
  const std::set<int> floor = room.before(4, 5);
  ASSERT_EQ(floor.size(), 2u);
  for (const int cell : floor) EXPECT_EQ(room.cells.closed[at(cell)], cell == inside);
}

TEST(Cells, ATwoSidedBodyInATwoSidedRoomHasAnInsideAndBelongsToTheRoom) {
  Scene scene = box(true);
  add_box(scene, {0.3, 0.3, 0.3}, {0.6, 0.6, 0.6}, false);
  for (Material& material : scene.materials) material.two_sided = true;
  const Parted parted(scene);
  std::set<int> inside, outside, walls;
  for (int e = 0; e < parted.elements.count(); ++e) {
    const Surface& surface = parted.scene.surfaces[at(parted.elements.surface[at(e)])];
    std::set<int>& cells = parted.elements.face[at(e)] < 6 ? walls
                           : surface.back                  ? inside
                                                           : outside;
    if (parted.elements.face[at(e)] >= 6 || !surface.back) cells.insert(parted.cells.before(e));
  }
  EXPECT_EQ(outside, walls);
  EXPECT_EQ(walls.size(), 1u);
  EXPECT_EQ(inside.size(), 1u);
  EXPECT_NE(inside, outside);
}

TEST(Cells, ABodyOnItsCornerTouchesTheFloorOnly) {
  Scene scene = box(true);
  const std::size_t first = scene.vertices.size();
  add_box(scene, Vec3::Zero(), Vec3::Constant(.2), false);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::Ones(), Vec3::UnitZ());
  for (std::size_t v = first; v < scene.vertices.size(); ++v)
    scene.vertices[v] = turn * scene.vertices[v] + Vec3(.5, .5, 0);
  const Parted room(scene);
  EXPECT_TRUE(room.are_closed(0, 12));
}

TEST(Cells, RoomsSideBySideAreSeparate) {
  Scene scene = box(true);
  add_box(scene, {1, 0, 0}, {2, 1, 1}, true);  // shares a wall of no thickness
  add_box(scene, {5, 0, 0}, {5.5, .5, .5}, true);
  const Parted rooms(scene);
  EXPECT_TRUE(rooms.are_closed(0, 6));
  EXPECT_TRUE(rooms.are_closed(6, 12));
  EXPECT_TRUE(rooms.are_closed(12, 18));
  EXPECT_NE(rooms.before(0, 6), rooms.before(6, 12));
  EXPECT_NE(rooms.before(0, 6), rooms.before(12, 18));
}

TEST(Cells, AWallThroughARoomPartsItAndAPaneThroughAWallDoesNot) {
  Scene scene = test::room({2, 1, 1}, {});
  const int wall = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}, wall);
  scene.materials[at(wall)].two_sided = true;
  const Parted parted(scene);
  EXPECT_EQ(parted.before(0, 2).size(), 2u);
  for (const int cell : parted.before(0, 7)) EXPECT_TRUE(parted.cells.closed[at(cell)]);
  EXPECT_EQ(parted.before(0, 7).size(), 2u);
  // Half of a pane in each room: the two stay apart, and each closed.
  test::add_polygon(scene, {{.5, .2, .5}, {1.5, .2, .5}, {1.5, .8, .5}, {.5, .8, .5}}, wall);
  const Parted pierced(scene);
  EXPECT_EQ(pierced.before(0, 8).size(), 2u);
  for (const int cell : pierced.before(0, 8)) EXPECT_TRUE(pierced.cells.closed[at(cell)]);
  // A wall that is not as high as the room.
  for (Vec3& p : scene.vertices)
    if (p.x() == 1 && p.z() == 1) p.z() = 0.999;
  EXPECT_EQ(Parted(scene).before(0, 8).size(), 1u);
}

TEST(Cells, TellTheGapsOfWhatCountsAsClosed) {
  const auto gaps = [](const Scene& scene) {
    const Parted parted(scene);
    EXPECT_TRUE(parted.are_closed(0, 6));
    return parted.cells.gaps[at(*parted.before(0, 1).begin())];
  };
  EXPECT_NEAR(gaps(test::box_with_a_lifted_lid(1e-6, 0.5)), 4e-6, 1e-12);
  Scene turned = test::box_with_a_lifted_lid(0, 0.5);
  EXPECT_EQ(gaps(turned), 0);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Vec3& p : turned.vertices) p = turn * p + Vec3(3, 1, 7);
  EXPECT_EQ(gaps(turned), 0) << "rounding";
}

/// Splinters between corners that differ turn any way, and no cell may end at them.
TEST(Cells, BodiesBelongToTheRoomIfCornersDiffer) {
  Scene scene = box(true);
  add_box(scene, {0.3, 0.2, 0.1}, {0.6, 0.5, 0.2}, false);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Parted parted(test::with_own_corners(scene, 1e-7, seed), 1);
    std::set<int> before;
    for (int e = 0; e < parted.elements.count(); ++e)
      if (parted.elements.area[at(e)] > 1e-4) before.insert(parted.cells.before(e));
    EXPECT_EQ(before.size(), 1U) << "seed " << seed;
  }
}

}  // namespace
}  // namespace halfshade
