#include "solver/factors/body_search.h"

#include "solver/factors/factor_matrix.h"
#include "solver/factors/factor_scene.h"
#include "solver/factors/few_blockers.h"
#include "tests/solver/factors/sight_points.h"
#include "tests/support/balls.h"
#include "tests/support/face_factors.h"
#include "tests/support/random.h"
#include "tests/support/round_things.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

/// Sides of a box.
enum Side { left, right, front, back, bottom, top };
const std::vector<Side> all_sides_of_box = {left, right, front, back, bottom, top};
const std::vector<Side> upright = {left, right, front, back};

/// Some sides of a box, looking outwards.
void add_sides(Scene& scene, const Vec3& low, const Vec3& size, const std::vector<Side>& sides) {
  const std::array<Vec3, 3> e = {Vec3(size.x(), 0, 0), Vec3(0, size.y(), 0), Vec3(0, 0, size.z())};
  for (const Side side : sides) {
    const auto k = static_cast<std::size_t>(side) / 2;
    const bool is_high = side % 2 == 1;
    const Vec3 corner = is_high ? low + e[k] : low;
    const Vec3 &u = e[(k + (is_high ? 1 : 2)) % 3], &v = e[(k + (is_high ? 2 : 1)) % 3];
    test::add_polygon(scene, {corner, corner + u, corner + u + v, corner + v}, 0);
  }
}

void add_sheet(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v) {
  test::add_polygon(scene, {corner, corner + u, corner + u + v, corner + v}, 0);
}

Scene with_material() {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  return scene;
}

SightScene sight_of(const Scene& scene) {
  return make_sight_scene(make_factor_scene(scene, FactorUnit::face).sound);
}

void expect_box(const ConvexBody& body, std::size_t open_sides) {
  EXPECT_EQ(body.open_sides, open_sides);
  EXPECT_EQ(body.vertices.size(), 8u);
  EXPECT_EQ(body.sides.size(), 6u);
  EXPECT_EQ(body.edges.size(), 12u);
  for (const auto& [ends, sides] : body.edges) {
    EXPECT_NE(ends[0], ends[1]);
    EXPECT_NE(sides[0], sides[1]);
  }
  const double near = 1e-12;
  for (const ConvexBody::Side& side : body.sides)
    for (const Vec3& p : body.vertices) EXPECT_LE(side.normal.dot(p - side.corner), near);
}

TEST(BodySearch, BoxesAreBodiesIfOneSideAtMostIsMissing) {
  for (const Side missing : all_sides_of_box) {
    std::vector<Side> sides = all_sides_of_box;
    std::erase(sides, missing);
    Scene scene = with_material();
    add_sides(scene, {0, 0, 1}, {1, 2, 3}, sides);
    const SightScene sight = sight_of(scene);
    ASSERT_EQ(sight.bodies.size(), 1u) << missing;
    expect_box(sight.bodies[0], 1);
    for (const Side other : sides) {
      std::vector<Side> fewer = sides;
      std::erase(fewer, other);
      Scene open = with_material();
      add_sides(open, {0, 0, 1}, {1, 2, 3}, fewer);
      EXPECT_TRUE(sight_of(open).bodies.empty()) << missing << other;
    }
  }
}

/// Where it stands on a floor, whose edges are no part of it.
TEST(BodySearch, WhatABoxStandsOnIsNoPartOfIt) {
  Scene scene = with_material();
  add_sheet(scene, {-1, -1, 0}, {4, 0, 0}, {0, 4, 0});
  add_sides(scene, Vec3::Zero(), {1, 1, 1}, all_sides_of_box);
  add_sides(scene, {1.5, 0, 0}, {1, 1, 1}, {left, right, front, back, top});
  const SightScene sight = sight_of(scene);
  ASSERT_EQ(sight.bodies.size(), 2u);
}

TEST(BodySearch, LegsAreBodiesIfBothEndsAreCovered) {
  const auto bodies = [](const Vec3& floor, double width_of_top) {
    Scene scene = with_material();
    add_sheet(scene, floor, {4, 0, 0}, {0, 4, 0});
    add_sheet(scene, {0, 0, 1}, {width_of_top, 0, 0}, {0, 1, 0});
    add_sides(scene, {.4, .4, 0}, {.1, .2, 1}, upright);
    return sight_of(scene).bodies;
  };
  ASSERT_EQ(bodies({-1, -1, 0}, 1).size(), 1u);
  expect_box(bodies({-1, -1, 0}, 1)[0], 2);
  EXPECT_TRUE(bodies({-1, -1, -.1}, 1).empty()) << "hovers";
  EXPECT_TRUE(bodies({.45, -1, 0}, 1).empty()) << "half of it beside the floor";
  EXPECT_TRUE(bodies({-1, -1, 0}, .45).empty()) << "half of it beside the top";
}

TEST(BodySearch, WhatIsNotConvexIsNoBody) {
  Scene scene = with_material();
  // An L of six sides and two ends.
  const std::array<Vec2, 6> l = {Vec2(0, 0), {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  std::vector<Vec3> low, high;
  for (const Vec2& p : l) {
    low.insert(low.begin(), Vec3(p.x(), p.y(), 0));
    high.emplace_back(p.x(), p.y(), 1);
  }
  test::add_polygon(scene, low, 0);
  test::add_polygon(scene, high, 0);
  for (std::size_t k = 0; k < l.size(); ++k) {
    const Vec2 &a = l[k], &b = l[(k + 1) % l.size()];
    test::add_polygon(
        scene, {{a.x(), a.y(), 0}, {b.x(), b.y(), 0}, {b.x(), b.y(), 1}, {a.x(), a.y(), 1}}, 0);
  }
  EXPECT_TRUE(sight_of(scene).bodies.empty());
}

TEST(BodySearch, WhatIsFlatIsNoBody) {
  Scene scene = with_material();
  for (const Vec2& p : {Vec2(0, 0), {1, 0}, {2, 0}, {0, 1}})
    add_sheet(scene, {p.x(), p.y(), 0}, {1, 0, 0}, {0, 1, 0});
  const SoundScene tiles = make_factor_scene(scene, FactorUnit::face).sound;
  EXPECT_TRUE(find_convex_bodies(tiles, OpaqueScene(tiles)).bodies.empty());
}

/// A room with a table on four legs, a box without a bottom on the floor and one above it, one that
/// is open to a wall that it stands at, a cup, and a pipe that hangs from the ceiling.
Scene furnished_room() {
  Scene scene = with_material();
  add_sheet(scene, {0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  add_sheet(scene, {0, 0, 0}, {0, 3, 0}, {0, 0, 2.5});
  add_sheet(scene, {0, 3, 0}, {4, 0, 0}, {0, 0, 2.5});
  add_sheet(scene, {4, 3, 2.5}, {0, -3, 0}, {0, 0, -2.5});
  add_sheet(scene, {0, 3, 2.5}, {4, 0, 0}, {0, -3, 0});
  add_sides(scene, {1, 1, .7}, {1.2, .8, .05}, all_sides_of_box);
  for (const double x : {1.05, 2.05})
    for (const double y : {1.05, 1.65}) add_sides(scene, {x, y, 0}, {.1, .1, .7}, upright);
  add_sides(scene, {2.6, .4, 0}, {.6, .5, .8}, {left, right, front, back, top});
  add_sides(scene, {2.7, 1.6, .3}, {.5, .6, .5}, {left, right, front, back, top});
  add_sides(scene, {0, .2, .9}, {.3, .6, .6}, {right, front, back, bottom, top});
  add_sides(scene, {1.3, 1.2, .8}, {.2, .2, .2}, {left, right, front, back, bottom});
  add_sides(scene, {3.4, 2.2, .6}, {.2, .2, 1.9}, upright);
  return scene;
}

/// From everywhere, under legs and boxes, too, and at backs of sides.
TEST(BodySearch, OpenBodiesHideWhatTheirSidesHide) {
  const FactorScene factors = make_factor_scene(furnished_room(), FactorUnit::face);
  const SightScene sight = make_sight_scene(factors.sound);
  std::array<int, 3> count = {};
  for (const ConvexBody& body : sight.bodies) ++count[body.open_sides];
  EXPECT_EQ(count, (std::array{1, 4, 4})) << "closed; open on one side; covered on both";
  const DirectLightIndex exact(factors.sound);
  test::Random random(5);
  int partial = 0, dark = 0, lit = 0;
  const int surfaces = static_cast<int>(sight.surfaces.size());
  for (int a = 0; a < surfaces; ++a) {
    const SightSurface& from = sight.surfaces[at(a)];
    if (from.outline.size() != 4 || from.rings.size() > 1) continue;
    SharedShadows shadows(sight);
    TargetMemory memory;
    const auto targets = test::targets_of(sight, a, shadows, memory);
    for (int k = 0; k < 4; ++k) {
      const Vec3 point = test::point_of(from, random);
      shadows.move_to(point);
      for (const auto& [b, target] : targets) {
        const PointFactor expected = exact.factor({point, from.frame.normal}, b);
        HiddenFactor shaded, cut;
        ASSERT_TRUE(target.hidden_factor(shaded));
        ASSERT_TRUE(FewBlockers(sight, a, b).factor(point, cut));
        EXPECT_NEAR(shaded.hidden, expected.unobstructed - expected.visible, 1e-12)
            << a << " " << b;
        EXPECT_NEAR(cut.hidden, expected.unobstructed - expected.visible, 1e-12) << a << " " << b;
        partial += expected.region == Region::penumbra;
        dark += expected.region == Region::umbra;
        lit += expected.region == Region::lit;
      }
    }
  }
  EXPECT_GT(partial, 1000);
  EXPECT_GT(dark, 300);
  EXPECT_GT(lit, 1000);
}

/// A box that is open above, and a board of two halves through it that stick out far on both sides:
/// its sides hide all corners of the board from all of a small plate over the box.
TEST(BodySearch, WhatLooksIntoAnOpenBodySeesWhatPiercesIt) {
  Scene scene = with_material();
  add_sides(scene, Vec3::Zero(), {1, 1, .2}, {left, right, front, back, bottom});
  add_sheet(scene, {-9, .4, .1}, {9.5, 0, 0}, {0, .2, 0});
  add_sheet(scene, {.5, .4, .1}, {9.5, 0, 0}, {0, .2, 0});
  add_sheet(scene, {.45, .55, .201}, {.1, 0, 0}, {0, -.1, 0});
  ASSERT_EQ(sight_of(scene).bodies.size(), 1u);
  const FactorMatrix matrix = test::face_factors(scene, 1e-4);
  EXPECT_GT(matrix.factors(7, 5), .3);
  EXPECT_GT(matrix.factors(7, 6), .3);
  EXPECT_NEAR(matrix.row_sum[7], 1, 1e-4);
}

/// However many of its sides lie in between.
TEST(BodySearch, OneBodyHidesAllThoughItHasManySides) {
  Scene scene = with_material();
  add_sheet(scene, {-2, -.2, .8}, {0, .4, 0}, {0, 0, .4});
  add_sheet(scene, {2, .2, .8}, {0, -.4, 0}, {0, 0, .4});
  test::add_cylinder(scene, {{0, 0, 0}, 1, 2, 400, true}, 0);
  const FactorScene factors = make_factor_scene(scene, FactorUnit::face);
  const SightScene sight = make_sight_scene(factors.sound);
  ASSERT_TRUE(may_see(sight, 0, 1));
  EXPECT_GT(blockers_between(sight, 0, 1).size(), 40u);
  EXPECT_EQ(sight_between(sight, 0, 1), Sight::none);
}

/// Of a ball of 1,280 facets walls see their share of what it sees of them, which is all; what they
/// see of each other is less, by one silhouette. (With bodies of up to 1,024 edges only, 83,000
/// points were looked at.)
TEST(BodySearch, BallsOfManyFacetsHideWallsFromEachOther) {
  const FactorMatrix matrix = test::material_factors(test::room_with_balls(1, 3), 1e-4);
  const double of_ball = matrix.area[1] / matrix.area[0];
  EXPECT_NEAR(matrix.factors(0, 1), of_ball, 1e-9);
  EXPECT_NEAR(matrix.factors(0, 0), 1 - of_ball, 5e-6);
  EXPECT_LT(matrix.report.points, 20000u);
}

}  // namespace
}  // namespace halfshade
