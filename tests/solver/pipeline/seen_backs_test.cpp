#include "solver/pipeline/seen_backs.h"

#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A closed room with a cube in it, from this height on.
SoundScene room_with_cube(double height) {
  Scene scene;
  const int grey = test::add_material(scene, 0.2, 0);
  for (const auto& face : test::box_faces({0, 0, 0}, {2, 1, 1.5}, true))
    test::add_polygon(scene, face, grey);
  for (const auto& face : test::box_faces({0.3, 0.3, height}, {0.7, 0.7, height + 0.4}, false))
    test::add_polygon(scene, face, grey);
  return make_sound(scene);
}

TEST(SeenBacks, AreNamedBelowAndInsideOfBodies) {
  const Heat heat;
  EXPECT_TRUE(back_warnings(room_with_cube(0.1), heat).empty());
  const std::vector<Warning> standing = back_warnings(room_with_cube(0), heat);
  ASSERT_EQ(standing.size(), 1U);
  EXPECT_EQ(standing[0].kind, Warning::Kind::backs_exchange);
  EXPECT_NE(standing[0].sentence.find("an area of 0.16"), std::string::npos)
      << standing[0].sentence;
  EXPECT_EQ(back_warnings(room_with_cube(1.3), heat).size(), 1U) << "through the ceiling";
}

}  // namespace
}  // namespace halfshade
