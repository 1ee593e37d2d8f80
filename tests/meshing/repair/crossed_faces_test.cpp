#include "meshing/core/planar.h"
#include "meshing/repair/repair.h"
#include "meshing/repair/repair_sentence.h"
#include "tests/support/random.h"
#include "tests/support/repair_scenes.h"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>
#include <vector>

// Faces whose boundary crosses itself.

namespace halfshade {
namespace {

using test::only;
using test::rectangle;
using test::scene_of;
using test::total_area;
using testing::ElementsAre;

/// Areas that look up and down, in the scene's z.
struct Lying {
  double up = 0, down = 0;
};

Lying lying(const SoundScene& sound) {
  Lying areas;
  for (const Surface& surface : sound.surfaces) {
    EXPECT_NEAR(std::abs(surface.frame.normal.z()), 1, 1e-15);
    (surface.frame.normal.z() > 0 ? areas.up : areas.down) += area(surface);
  }
  return areas;
}

SoundScene sound_face(const std::vector<Vec3>& polygon) {
  return make_sound(scene_of({{polygon, 0}}));
}

TEST(CrossedFaces, PartsOfABowTieLookOppositeWays) {
  const SoundScene sound = sound_face({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(sound.surfaces.size(), 2u);
  const Lying areas = lying(sound);
  EXPECT_NEAR(areas.up, 0.25, 1e-15);
  EXPECT_NEAR(areas.down, 0.25, 1e-15);
  EXPECT_THAT(only(sound, Repair::Kind::crossed_split).faces, ElementsAre(0));
}

TEST(CrossedFaces, PartsOfABowTieMayDiffer) {
  // Sides x = y and y = 1 − x / 2 meet at (2/3, 2/3).
  const Lying areas = lying(sound_face({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}}));
  EXPECT_NEAR(areas.up, 1. / 3, 1e-15);
  EXPECT_NEAR(areas.down, 4. / 3, 1e-15);
}

TEST(CrossedFaces, WhatIsGoneRoundTwiceIsThereOnce) {
  // A five-pointed star of circumradius 1: ten triangles of half its height and its tips' angle.
  std::vector<Vec3> star;
  for (int k = 0; k < 5; ++k) {
    const double angle = 4 * std::numbers::pi * k / 5;
    star.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const SoundScene sound = sound_face(star);
  EXPECT_EQ(sound.surfaces.size(), 1u);
  const double inner = std::sin(std::numbers::pi / 10) / std::sin(3 * std::numbers::pi / 10);
  EXPECT_NEAR(lying(sound).up, 5 * inner * std::sin(std::numbers::pi / 5), 1e-14);
  EXPECT_EQ(lying(sound).down, 0);
}

TEST(CrossedFaces, PartsThatMeetInACornerAreSplitAsWell) {
  // Crosses itself in the point 1, 1, which it visits twice.
  const Lying areas =
      lying(sound_face({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {2, 0, 0}, {1, 1, 0}, {0, 2, 0}}));
  EXPECT_NEAR(areas.up, 1, 1e-15);
  EXPECT_NEAR(areas.down, 1, 1e-15);
}

TEST(CrossedFaces, OthersStayAsTheyAre) {
  // The bow tie lies in the square's plane, and beside it.
  const SoundScene sound = make_sound(
      scene_of({{rectangle(5, 5, 6, 6, 0), 0}, {{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 1}}));
  ASSERT_EQ(sound.surfaces.size(), 3u);
  EXPECT_DOUBLE_EQ(area(sound.surfaces[0]), 1);
  EXPECT_NEAR(total_area(sound), 1.5, 1e-15);
  EXPECT_EQ(sound.repairs.size(), 1u);
}

TEST(CrossedFaces, FacesThatAreNotPlanarBecomeTrianglesBetweenTheirCorners) {
  const std::vector<Vec3> twisted = {{0, 0, 0}, {1, 1, 0.3}, {1, 0, 0}, {0, 1, 0.3}};
  const SoundScene sound = sound_face(twisted);
  ASSERT_EQ(sound.surfaces.size(), 2u);
  only(sound, Repair::Kind::crossed_split);
  // They are bounded by the face: area vectors add up to its own.
  Vec3 sum = Vec3::Zero();
  for (const Surface& surface : sound.surfaces) sum += area(surface) * surface.frame.normal;
  EXPECT_LT((sum - area_vector(twisted)).norm(), 1e-14);
}

/// How often a closed polygon goes round a point, counter-clockwise in x and y.
int winding_number(const std::vector<Vec3>& polygon, const Vec2& p) {
  int winding = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k].head<2>() - p, b = polygon[(k + 1) % polygon.size()].head<2>() - p;
    if ((a.y() > 0) == (b.y() > 0)) continue;
    if ((cross_2d(a, b) > 0) == (b.y() > a.y())) winding += b.y() > a.y() ? 1 : -1;
  }
  return winding;
}

/// How many surfaces that look up, or down, are over or under a point.
int surfaces_at(const SoundScene& sound, const Vec2& p, bool up) {
  int count = 0;
  for (const Surface& surface : sound.surfaces)
    if ((surface.frame.normal.z() > 0) == up)
      count += is_inside(surface.rings, surface.frame.to_plane({p.x(), p.y(), 0})) ? 1 : 0;
  return count;
}

TEST(CrossedFaces, RandomOnesLookToWhereTheyAreGoneRoundCounterClockwise) {
  test::Random random(24);
  int twice = 0;
  for (int trial = 0; trial < 300; ++trial) {
    // On whole numbers corners and sides come to lie on each other, too.
    std::vector<Vec3> polygon;
    const int corners = random.integer(4, 12);
    for (int k = 0; k < corners; ++k) {
      const double x = random.integer(0, 4), y = random.integer(0, 4);
      polygon.emplace_back(x, y, 0);
    }
    const auto ground = rectangle(9, 9, 10, 10);
    const SoundScene sound = make_sound(scene_of({{ground, 1}, {polygon, 0}}));
    for (int k = 0; k < 40; ++k) {
      const Vec2 p = random.point(0, 4).head<2>();
      const int winding = winding_number(polygon, p);
      EXPECT_EQ(surfaces_at(sound, p, true), winding > 0) << trial << " at " << p.transpose();
      EXPECT_EQ(surfaces_at(sound, p, false), winding < 0) << trial << " at " << p.transpose();
      twice += std::abs(winding) > 1;
    }
  }
  EXPECT_GT(twice, 100);
}

TEST(CrossedFaces, RandomTwistedOnesBoundTheirTriangles) {
  test::Random random(25);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec3> polygon;
    for (int k = random.integer(4, 9); k > 0; --k) polygon.push_back(random.point(0, 1));
    Vec3 sum = Vec3::Zero();
    for (const Surface& surface : sound_face(polygon).surfaces)
      sum += area(surface) * surface.frame.normal;
    EXPECT_LT((sum - area_vector(polygon)).norm(), 1e-8) << trial;
  }
}

TEST(CrossedFaces, TwistedOnesOfVeryManyCornersAreTakenAsWell) {
  // Twice round a ring that rises and falls.
  std::vector<Vec3> ring;
  constexpr int corners = 3000;
  for (int k = 0; k < corners; ++k) {
    const double angle = 4 * std::numbers::pi * k / corners, radius = 1 + 0.2 * std::cos(angle / 2);
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                      0.01 * std::sin(7 * angle));
  }
  const SoundScene sound = sound_face(ring);
  EXPECT_GT(total_area(sound), 3);
  EXPECT_LT(total_area(sound), 5);
}

}  // namespace
}  // namespace halfshade
