#include "meshing/repair/orientation.h"

#include "meshing/core/plane_frame.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace halfshade {
namespace {

void add_box(Scene& scene, double low, double high, double exitance) {
  const int material = test::add_material(scene, 0.5, exitance);
  for (const auto& face : test::box_faces(Vec3::Constant(low), Vec3::Constant(high), false))
    test::add_polygon(scene, face, material);
}

/// Six times the volume that six faces from `first` on bound, if they look outwards.
double outwards(const Scene& scene, int first) {
  double sum = 0;
  for (int f = first; f < first + 6; ++f) {
    const std::vector<Vec3> corners = face_corners(scene, f);
    sum += corners[0].dot(area_vector(corners));
  }
  return sum;
}

void mix_up(Scene& scene) {
  for (const int f : {1, 2, 5, 7, 10})
    if (f < static_cast<int>(scene.faces.size()))
      std::reverse(scene.faces[at(f)].vertices.begin(), scene.faces[at(f)].vertices.end());
}

TEST(Oriented, FlipReversesEveryFace) {
  Scene scene;
  add_box(scene, 0, 1, 1);
  const Scene flipped = oriented(scene, {.flip = true});
  EXPECT_NEAR(outwards(scene, 0), 3, 1e-12);
  EXPECT_NEAR(outwards(flipped, 0), -3, 1e-12);
}

TEST(Oriented, TheRoomLooksInwardsAndWhatIsInItOutwards) {
  Scene scene;
  add_box(scene, 0, 4, 0);    // the room
  add_box(scene, 1, 1.5, 0);  // furniture
  add_box(scene, 2, 2.5, 1);  // a lamp
  mix_up(scene);
  const Scene turned = oriented(scene, {.orient = true});
  EXPECT_NEAR(outwards(turned, 0), -3 * 64, 1e-9);
  EXPECT_NEAR(outwards(turned, 6), 3 * 0.125, 1e-12);
  EXPECT_NEAR(outwards(turned, 12), 3 * 0.125, 1e-12);
}

TEST(Oriented, AShellWithALampAmongItsFacesLooksInwards) {
  Scene scene;
  add_box(scene, 0, 1, 0);
  add_box(scene, 2, 8, 0);  // larger, but without any light
  scene.faces[4].material = test::add_material(scene, 0, 1);
  mix_up(scene);
  const Scene turned = oriented(scene, {.orient = true});
  EXPECT_NEAR(outwards(turned, 0), -3, 1e-12);
  EXPECT_NEAR(outwards(turned, 6), 3 * 216, 1e-9);
}

TEST(Oriented, WithoutSuchAShellTheLargestLooksInwardsAndSheetsStay) {
  Scene scene;
  add_box(scene, 0, 1, 1);
  add_box(scene, 2, 8, 1);
  test::add_polygon(scene, {{9, 0, 0}, {10, 0, 0}, {10, 1, 0}}, 0);
  const Scene turned = oriented(scene, {.orient = true});
  EXPECT_NEAR(outwards(turned, 0), 3, 1e-12);
  EXPECT_NEAR(outwards(turned, 6), -3 * 216, 1e-9);
  EXPECT_EQ(turned.faces[12].vertices, scene.faces[12].vertices);
}

}  // namespace
}  // namespace halfshade
