#include "meshing/repair/canonical_order.h"

#include "meshing/repair/repair.h"
#include "tests/support/random_scene.h"
#include "tests/support/repair_scenes.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <random>

namespace halfshade {
namespace {

/// The same scene as another file may have it.
Scene shuffled(const Scene& scene, unsigned seed) {
  std::mt19937 random(seed);
  Scene result = scene;
  std::vector<int> before(scene.vertices.size());
  for (std::size_t v = 0; v < before.size(); ++v) before[v] = static_cast<int>(v);
  std::shuffle(before.begin(), before.end(), random);
  std::vector<int> now(before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    result.vertices[k] = scene.vertices[at(before[k])];
    now[at(before[k])] = static_cast<int>(k);
  }
  for (Face& face : result.faces) {
    for (int& v : face.vertices) v = now[at(v)];
    std::rotate(face.vertices.begin(),
                face.vertices.begin() + static_cast<int>(random() % face.vertices.size()),
                face.vertices.end());
  }
  std::shuffle(result.faces.begin(), result.faces.end(), random);
  return result;
}

TEST(CanonicalOrder, IsTheSameForAnyOrder) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Scene scene = test::random_scene(seed);
    const OrderedScene one = in_canonical_order(scene);
    const OrderedScene other = in_canonical_order(shuffled(scene, seed));
    ASSERT_TRUE(one.scene.vertices == other.scene.vertices);
    ASSERT_EQ(one.scene.faces.size(), other.scene.faces.size());
    for (std::size_t f = 0; f < one.scene.faces.size(); ++f) {
      EXPECT_EQ(one.scene.faces[f].vertices, other.scene.faces[f].vertices);
      EXPECT_EQ(one.scene.faces[f].material, other.scene.faces[f].material);
      EXPECT_EQ(one.scene.faces[f].group, other.scene.faces[f].group);
    }
  }
}

TEST(CanonicalOrder, KeepsEveryFaceAsItLooks) {
  const Scene scene = test::random_scene(3);
  const OrderedScene ordered = in_canonical_order(scene);
  std::vector<int> faces = ordered.face;
  std::sort(faces.begin(), faces.end());
  for (std::size_t f = 0; f < faces.size(); ++f) EXPECT_EQ(faces[f], static_cast<int>(f));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const int original = ordered.face[f];
    std::vector<Vec3> now = face_corners(ordered.scene, static_cast<int>(f)),
                      before = face_corners(scene, original);
    EXPECT_EQ(ordered.scene.faces[f].line, scene.faces[at(original)].line);
    const auto begin = std::find(before.begin(), before.end(), now.front());
    ASSERT_NE(begin, before.end());
    std::rotate(before.begin(), begin, before.end());
    EXPECT_TRUE(now == before);
  }
}

TEST(CanonicalOrder, OfFacesWithTheSameCornersIsThatOfTheFile) {
  Scene scene;
  const int first = test::add_material(scene, 0.1, 0), second = test::add_material(scene, 0.2, 0);
  for (const int material : {second, first, second})
    test::add_polygon(scene, {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, material);
  EXPECT_EQ(in_canonical_order(scene).face, (std::vector<int>{0, 1, 2}));
}

TEST(CanonicalOrder, ZerosAreAlikeAndPlacesAreOne) {
  Scene scene;
  const int material = test::add_material(scene, 0.1, 0);
  test::add_polygon(scene, {{-0., 0, 0}, {1, 0, 0}, {0, 1, 0}}, material);
  test::add_polygon(scene, {{0, 0, -0.}, {0, 1, 0}, {-1, 0, 0}}, material);
  EXPECT_EQ(in_canonical_order(scene).scene.vertices.size(), 4u);
}

TEST(MakeSoundInAnyOrder, NamesFacesAsTheFileDoes) {
  Scene scene = test::table_scene();
  for (Face& face : scene.faces) face.line = 10 + static_cast<int>(&face - scene.faces.data());
  const SoundScene sound = make_sound_in_any_order(scene);
  ASSERT_EQ(sound.face_lines.size(), scene.faces.size());
  for (const Surface& surface : sound.surfaces)
    for (const int face : surface.faces) {
      EXPECT_EQ(surface.material, scene.faces[at(face)].material);
      EXPECT_EQ(sound.face_lines[at(face)], scene.faces[at(face)].line);
      EXPECT_NEAR(surface.frame.height(face_corners(scene, face).front()), 0, 1e-12);
    }
}

TEST(MakeSoundInAnyOrder, RepairsNameFacesAsTheFileDoes) {
  Scene scene;
  const int material = test::add_material(scene, 0.1, 1);
  test::add_polygon(scene, {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, material);
  test::add_polygon(scene, {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, material);  // crosses
  const SoundScene sound = make_sound_in_any_order(scene);
  EXPECT_THAT(test::only(sound, Repair::Kind::crossed_split).faces, testing::ElementsAre(1));
}

}  // namespace
}  // namespace halfshade
