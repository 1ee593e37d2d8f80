#include "meshing/repair/repair.h"
#include "tests/support/expect_error.h"
#include "tests/support/repair_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {
using test::add_polygon;
using test::contact_length;
using test::rectangle;
using test::scene_of;

// A floor of 4 × 4 with a closed box on it whose footprint is given.
Scene box_on_floor(double x0, double y0, double x1, double y1) {
  Scene scene = scene_of({{rectangle(0, 0, 4, 4), 0}});
  for (const auto& face : test::box_faces({x0, y0, 0}, {x1, y1, 1}, false))
    add_polygon(scene, face, 1);
  return scene;
}

TEST(Contacts, ABoxOnTheFloorLeavesItsFootprint) {
  const SoundScene sound = make_sound(box_on_floor(1, 1, 2, 3));
  const Surface& floor = sound.surfaces[0];
  EXPECT_EQ(floor.contacts.size(), 4u);  // the sides' and the bottom's edges are the same lines
  EXPECT_DOUBLE_EQ(test::length_of(floor.contacts), 6);
  EXPECT_DOUBLE_EQ(contact_length(sound), 6);
}

TEST(Contacts, AreLeftOrRefusedWhereThereAreTooMany) {
  const Scene scene = box_on_floor(1, 1, 2, 3);
  EXPECT_EQ(make_sound(scene, {.most_contacts = 4}).surfaces[0].contacts.size(), 4u);
  test::expect_error([&] { make_sound(scene, {.most_contacts = 3}); }, ErrorCode::too_large,
                     {"more than 3 pieces"});
  test::expect_error([&] { make_sound(scene, {.most_surfaces = 6}); }, ErrorCode::too_large,
                     {"7 surfaces"});
  EXPECT_TRUE(make_sound(scene, {.contacts = false}).surfaces[0].contacts.empty());
}

TEST(Contacts, AreClippedToTheSurfaceAndEndInCornersOfItsBoundary) {
  const SoundScene sound = make_sound(box_on_floor(3, 1, 5, 2));
  const Surface& floor = sound.surfaces[0];
  EXPECT_DOUBLE_EQ(test::length_of(floor.contacts), 3);
  EXPECT_EQ(floor.rings[0].size(), 6u);
  for (const Vec2& end : {Vec2(4, 1), Vec2(4, 2)}) {
    const Vec2 place = floor.frame.to_plane({end.x(), end.y(), 0});
    EXPECT_TRUE(std::any_of(floor.rings[0].begin(), floor.rings[0].end(),
                            [&](const Vec2& p) { return (p - place).norm() < 1e-14; }));
  }
}

TEST(Contacts, ABoxFlushWithTheBorderHasThreeInnerLines) {
  EXPECT_DOUBLE_EQ(contact_length(make_sound(box_on_floor(0, 1, 1, 2))), 3);
}

TEST(Contacts, BoxesThatOverlapShareLinesOnce) {
  Scene scene = box_on_floor(1, 1, 2, 2);
  for (const auto& face : test::box_faces({1.5, 1, 0}, {3, 2, 1}, false))
    add_polygon(scene, face, 2);
  const SoundScene sound = make_sound(scene);
  // Union of the two footprints: 2 × 1, and the two edges inside.
  EXPECT_DOUBLE_EQ(test::length_of(sound.surfaces[0].contacts), 6 + 2);
}

TEST(Contacts, AVerticalSheetLeavesOneLine) {
  Scene scene = scene_of({{rectangle(0, 0, 4, 4), 0}});
  add_polygon(scene, {{1, 2, 0}, {3, 2, 0}, {3, 2, 1}, {1, 2, 1}}, 3);
  const SoundScene sound = make_sound(scene);
  EXPECT_EQ(sound.surfaces[0].contacts.size(), 1u);
  EXPECT_DOUBLE_EQ(contact_length(sound), 2);
}

TEST(Contacts, WallsThatMeetAtEdgesHaveNone) {
  EXPECT_EQ(contact_length(make_sound(test::l_room(true))), 0);
}

TEST(Contacts, FollowHoles) {
  Scene scene = scene_of({{rectangle(0, 0, 4, 1), 0},
                          {rectangle(0, 3, 4, 4), 0},
                          {rectangle(0, 1, 1, 3), 0},
                          {rectangle(3, 1, 4, 3), 0}});
  add_polygon(scene, {{0.5, 2, 0}, {3.5, 2, 0}, {3.5, 2, 1}, {0.5, 2, 1}}, 1);
  const SoundScene sound = make_sound(scene);
  EXPECT_DOUBLE_EQ(contact_length(sound), 1);
  EXPECT_EQ(sound.surfaces[0].contacts.size(), 2u);
}

}  // namespace
}  // namespace halfshade
