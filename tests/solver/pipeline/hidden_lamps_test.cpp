#include "solver/pipeline/hidden_lamps.h"

#include "meshing/repair/repair.h"
#include "solver/pipeline/solve.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A lamp of 1 by 1 so high above the ceiling of a room of 2 by 2 by 2, looking down as it does.
Scene room_with_a_lamp(double above) {
  Scene scene;
  const int white = test::add_material(scene, 0.5, 0), lamp = test::add_material(scene, 0, 1);
  for (const auto& face : test::box_faces(Vec3::Zero(), Vec3::Constant(2), true))
    test::add_polygon(scene, face, white);
  const double z = 2 + above;
  test::add_polygon(scene, {{0.5, 0.5, z}, {0.5, 1.5, z}, {1.5, 1.5, z}, {1.5, 0.5, z}}, lamp);
  return scene;
}

std::string hidden(const Scene& scene) { return hidden_lamps(make_sound(scene)); }

TEST(HiddenLamps, AreThoseCloseBehindAFaceThatLooksTheSameWay) {
  for (const double above : {1e-5, 1e-4, 1e-3}) {
    const std::string sentence = hidden(room_with_a_lamp(above));
    EXPECT_NE(sentence.find("face 7"), std::string::npos) << above << sentence;
    EXPECT_NE(sentence.find("100 % of it"), std::string::npos) << above << sentence;
  }
  for (const double above : {0., 1e-2, 0.5, -1e-5, -1e-3, -0.5})
    EXPECT_EQ(hidden(room_with_a_lamp(above)), "") << above;
}

TEST(HiddenLamps, OfATiltedLampAPartIsHidden) {
  Scene scene = room_with_a_lamp(0);
  for (Vec3& p : scene.vertices)
    if (p.x() == 0.5) p.z() += 1e-4;
  for (Vec3& p : scene.vertices)
    if (p.x() == 1.5) p.z() -= 1e-4;
  const std::string sentence = hidden(scene);
  EXPECT_NE(sentence.find("hides 5"), std::string::npos) << sentence;
}

TEST(HiddenLamps, LightBehindAFaceWithTwoSidesIsMeant) {
  Scene scene = room_with_a_lamp(1e-4);
  scene.materials.front().two_sided = true;
  EXPECT_EQ(hidden(scene), "");
}

TEST(HiddenLamps, ASolutionIsNotWhatWasAskedFor) {
  SolveOptions options;
  options.tolerance = 0.1;
  EXPECT_NE(solve(room_with_a_lamp(1e-5), options).not_reached, "");
  EXPECT_EQ(solve(room_with_a_lamp(-1e-5), options).not_reached, "");
}

}  // namespace
}  // namespace halfshade
