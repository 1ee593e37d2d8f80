#include "meshing/patches/shared_lines.h"

#include "tests/support/surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace halfshade {
namespace {

using test::add_lit_surface;
using test::finish;

std::set<int> surfaces_of(const SharedLines& shared, const SharedLine& line) {
  std::set<int> result;
  for (const int w : line.borders)
    result.insert(shared.borders[static_cast<std::size_t>(w)].surface);
  return result;
}

TEST(SharedLines, ACubeHasTwelveWithTwoBorderLinesEach) {
  SoundScene scene;
  test::add_box(scene, {0, 0, 0}, {1, 2, 3});
  finish(scene);
  const SharedLines shared = find_shared_lines(scene);
  EXPECT_EQ(shared.borders.size(), 24u);
  EXPECT_EQ(shared.lines.size(), 12u);
  double sum = 0;
  for (const SharedLine& line : shared.lines) {
    EXPECT_EQ(line.borders.size(), 2u);
    EXPECT_NEAR(line.direction.norm(), 1, 1e-15);
    const BorderLine& a = shared.borders[static_cast<std::size_t>(line.borders[0])];
    const BorderLine& b = shared.borders[static_cast<std::size_t>(line.borders[1])];
    // Faces that all look outwards run along their edge in opposite directions.
    EXPECT_NEAR(a.begin, b.end, 1e-14);
    EXPECT_NEAR(a.end, b.begin, 1e-14);
    sum += std::abs(a.end - a.begin);
  }
  EXPECT_NEAR(sum, 4 * (1 + 2 + 3), 1e-12);
}

TEST(SharedLines, BorderLinesAreListedBySurfaceRingsFirst) {
  SoundScene scene;
  add_lit_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_lit_surface(scene, {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  scene.surfaces[0].contacts = {{Vec2(-0.1, 0), Vec2(0.1, 0)}};
  finish(scene);
  const SharedLines shared = find_shared_lines(scene);
  EXPECT_EQ(shared.first_border, std::vector<int>({0, 5, 8}));
  EXPECT_TRUE(shared.lines.empty());
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(shared.borders[k].surface, 0);
    EXPECT_EQ(shared.borders[k].ends[0], scene.surfaces[0].rings[0][k]);
    EXPECT_EQ(shared.borders[k].line, -1);
  }
  EXPECT_EQ(shared.borders[4].ends[1], Vec2(0.1, 0));
}

TEST(SharedLines, EdgesOfDifferentLengthAndContactLinesShareOne) {
  SoundScene scene;
  // Two pages of different height on a floor, one above the other's edge in part; a far third.
  add_lit_surface(scene, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_lit_surface(scene, {{1, 2, 0}, {3, 2, 0}, {3, 2, 1}, {1, 2, 1}});
  add_lit_surface(scene, {{2, 2, 0}, {3.5, 2, 0}, {3.5, 3, 1}, {2, 3, 1}});
  add_lit_surface(scene, {{3.6, 2, 0}, {3.9, 2, 0}, {3.9, 2, 1}, {3.6, 2, 1}});
  const PlaneFrame& floor = scene.surfaces[0].frame;
  scene.surfaces[0].contacts = {{floor.to_plane({1, 2, 0}), floor.to_plane({3.5, 2, 0})},
                                {floor.to_plane({3.6, 2, 0}), floor.to_plane({3.9, 2, 0})}};
  finish(scene);
  const SharedLines shared = find_shared_lines(scene);
  ASSERT_EQ(shared.lines.size(), 2u);
  EXPECT_EQ(surfaces_of(shared, shared.lines[0]), std::set<int>({0, 1, 2}));
  EXPECT_EQ(surfaces_of(shared, shared.lines[1]), std::set<int>({0, 3}));
}

TEST(SharedLines, TouchingInAPointIsNotSharing) {
  SoundScene scene;
  add_lit_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_lit_surface(scene, {{1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}});  // continues an edge
  add_lit_surface(scene, {{0, 1, 0}, {1, 2, 0}, {0, 2, 1}});             // touches a corner
  add_lit_surface(scene, {{0.5, 0, 0}, {0.6, -1, 0}, {0.4, -1, 0.3}});   // touches an edge
  finish(scene);
  EXPECT_TRUE(find_shared_lines(scene).lines.empty());
}

TEST(SharedLines, CornersThatReachPastEachOtherAreNotShared) {
  SoundScene scene;
  const double past = 1e-7;
  add_lit_surface(scene, {{-past, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  add_lit_surface(scene, {{past, 0, 0}, {-0.3, 0.9, 0.1}, {-1, 0, 0.5}});
  add_lit_surface(scene, {{0, past, past}, {-0.3, -0.9, 0.1}, {0.2, -1, 0}});
  finish(scene);
  EXPECT_TRUE(find_shared_lines(scene).lines.empty());
}

TEST(SharedLines, CoplanarBorderLinesMustTouchWithinTheTolerance) {
  for (const double gap : {0.5, 2.}) {
    SoundScene scene;
    add_lit_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const double x = 1 + gap * 1e-9 * std::sqrt(5);
    add_lit_surface(scene, {{x, 0, 0}, {2, 0, 0}, {2, 1, 0}, {x, 1, 0}});
    finish(scene);
    EXPECT_EQ(find_shared_lines(scene).lines.size(), gap < 1 ? 1u : 0u);
  }
}

TEST(SharedLines, BorderLinesOfPlanesOffTheirCornersAreFoundInOrderOfDistance) {
  SoundScene scene;
  // A floor with its border at x = 0 and a contact line 1e-7 beside it; a border off by 3e-8 and a
  // box's side off by as much from the contact line.
  const double gap = 1e-7, off = 3e-8;
  add_lit_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_lit_surface(scene, {{-off, 0, 0}, {-off, 1, 0}, {-off, 1, 1}, {-off, 0, 1}});
  add_lit_surface(scene,
                  {{gap + off, 0, 0}, {gap + off, 0, 1}, {gap + off, 1, 1}, {gap + off, 1, 0}});
  const PlaneFrame& floor = scene.surfaces[0].frame;
  scene.surfaces[0].contacts = {{floor.to_plane({gap, 0, 0}), floor.to_plane({gap, 1, 0})}};
  finish(scene);
  const SharedLines shared = find_shared_lines(scene);
  ASSERT_EQ(shared.lines.size(), 2u);
  for (const SharedLine& line : shared.lines) EXPECT_EQ(line.borders.size(), 2u);
  EXPECT_EQ(surfaces_of(shared, shared.lines[0]), std::set<int>({0, 1}));
  EXPECT_EQ(surfaces_of(shared, shared.lines[1]), std::set<int>({0, 2}));
}

TEST(SharedLines, PlacesAlongALineKeepTheirDigitsFarFromTheOrigin) {
  SoundScene scene;
  const Vec3 far(1e6, -1e6, 1e6);
  test::add_box(scene, far, far + Vec3(1, 1, 1));
  finish(scene);
  const SharedLines shared = find_shared_lines(scene);
  EXPECT_EQ(shared.lines.size(), 12u);
  for (const BorderLine& border : shared.borders)
    EXPECT_NEAR(std::abs(border.end - border.begin), 1, 1e-15);
}

}  // namespace
}  // namespace halfshade
