#include "solver/factors/factor_matrix.h"

#include "solver/factors/mutual_sight.h"
#include "tests/support/analytic.h"
#include "tests/support/expect_error.h"
#include "tests/support/face_factors.h"
#include "tests/support/random.h"
#include "tests/support/scene_maker.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

using Polygon = std::vector<Vec3>;

/// Each polygon is a face, of a material of its own.
Scene scene_of(const std::vector<Polygon>& polygons) {
  Scene scene;
  for (const Polygon& polygon : polygons)
    test::add_polygon(scene, polygon, test::add_material(scene, 0.5, 0));
  return scene;
}

FactorMatrix factors(const Scene& scene, double tolerance, FactorUnit unit = FactorUnit::face) {
  FactorOptions options;
  options.tolerance = tolerance;
  options.unit = unit;
  return form_factor_matrix(scene, options);
}

/// The rectangle o, o+u, o+u+v, o+v.
Polygon rectangle(const Vec3& o, const Vec3& u, const Vec3& v) {
  return {o, o + u, o + u + v, o + v};
}

Polygon reversed(Polygon p) {
  std::reverse(p.begin(), p.end());
  return p;
}

Scene plates(double gap) {
  return scene_of(
      {rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), rectangle({0, 0, gap}, {0, 1, 0}, {1, 0, 0})});
}

/// The first face's factor to the second against what it should be, and to what is said of its
/// error.
void expect_factor(const Scene& scene, double expected) {
  const FactorScene sound = make_factor_scene(scene, FactorUnit::face);
  const SightScene sight = make_sight_scene(sound.sound);
  ASSERT_EQ(sight_between(sight, 0, 1), Sight::clear);
  const MutualSight seen = clear_sight(sight, 0, 1, {});
  const double factor = seen.value / sound.areas[0];
  EXPECT_NEAR(factor / expected, 1, 1e-8);
  EXPECT_LE(std::abs(factor - expected), seen.error / sound.areas[0] + 1e-13)
      << "closed forms cancel";
  EXPECT_TRUE(seen.is_reached);
}

TEST(FactorMatrix, ClosedFormsOfTwoRectangles) {
  expect_factor(scene_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, 2, 0}),
                          reversed(rectangle({0, 0, 1.5}, {1, 0, 0}, {0, 2, 0}))}),
                test::opposed_rectangles(1, 2, 1.5));
  expect_factor(scene_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}),
                          reversed(rectangle({.3, -.5, .8}, {1.7, 0, 0}, {0, 1.2, 0}))}),
                test::offset_parallel_rectangles({0, 1}, {0, 1.5}, {.3, 2}, {-.5, .7}, .8));
  expect_factor(scene_of({rectangle({.4, 0, 0}, {.8, 0, 0}, {0, 1.5, 0}),
                          rectangle({0, -.5, .3}, {0, 1.2, 0}, {0, 0, .6})}),
                test::offset_perpendicular_rectangles({.4, 1.2}, {0, 1.5}, {.3, .9}, {-.5, .7}));
  for (const auto& [l, w, h] : {std::array{1., 1., 1.}, {2., 1., 1.5}, {1., .7, 1.3}})
    expect_factor(scene_of({rectangle({0, 0, 0}, {w, 0, 0}, {0, l, 0}),
                            rectangle({0, 0, 0}, {0, l, 0}, {0, 0, h})}),
                  test::perpendicular_rectangles(l, w, h));
  for (const double degrees : {45., 60., 120.}) {
    const double phi = degrees * std::numbers::pi / 180;
    expect_factor(
        scene_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, .7, 0}),
                  rectangle({1, 0, 0}, {-1, 0, 0}, {0, 1.5 * std::cos(phi), 1.5 * std::sin(phi)})}),
        test::inclined_rectangles(1.5, .7, 1, phi));
  }
}

TEST(FactorMatrix, TetrahedronFromInside) {
  const std::array<Vec3, 4> p = {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
  const FactorMatrix matrix = factors(
      scene_of({{p[0], p[2], p[1]}, {p[0], p[1], p[3]}, {p[0], p[3], p[2]}, {p[1], p[2], p[3]}}),
      1e-9);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(matrix.factors(i, j), i == j ? 0 : 1. / 3, 3e-9);
    EXPECT_EQ(matrix.space[i], 0) << "nothing leaves";
  }
}

TEST(FactorMatrix, GapsOfAnySize) {
  for (const double gap : {1e-6, 1e-4, 1e-2, 10.})
    expect_factor(plates(gap), test::opposed_rectangles(1, 1, gap));
  // C-11 cancels where plates are far apart.
  for (const double gap : {1e4, 1e6})
    expect_factor(plates(gap), 1 / (std::numbers::pi * gap * gap));
}

TEST(FactorMatrix, WhatLeavesANarrowGapIsFoundInSpace) {
  for (const double gap : {0.1, 1e-2, 1e-4}) {
    const FactorMatrix matrix = factors(plates(gap), 1e-4);
    EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), 1e-4) << gap;
    EXPECT_NEAR(matrix.space[0], 1 - test::opposed_rectangles(1, 1, gap), matrix.error[0]) << gap;
    EXPECT_LE(matrix.error.maxCoeff(), 1e-4);
  }
}

TEST(FactorMatrix, NeitherScaleNorFarTrianglesChangeAnything) {
  const FactorMatrix plain = factors(test::table_scene(), 1e-4);
  for (const double scale : {1e-9, 1e9}) {
    Scene scene = test::table_scene();
    for (Vec3& p : scene.vertices) p *= scale;
    const FactorMatrix matrix = factors(scene, 1e-4);
    EXPECT_LT((matrix.factors - plain.factors).cwiseAbs().maxCoeff(), 2e-5) << scale;
    EXPECT_LT((matrix.space - plain.space).abs().maxCoeff(), 2e-5) << scale;
  }
  Scene scene = test::table_scene();
  const double far = 1e6;
  test::add_polygon(scene, {{far, 0, 0}, {far, 1, 0}, {far, 0, 1}},
                    test::add_material(scene, 0.5, 0));
  const FactorMatrix matrix = factors(scene, 1e-4);
  EXPECT_LT((matrix.factors.topLeftCorner(3, 3) - plain.factors).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((matrix.row_sum.head(3) - 1).abs().maxCoeff(), 2e-4);
}

TEST(FactorMatrix, RowsOfAConcaveRoomWithAThingInIt) {
  const FactorMatrix matrix = factors(test::l_room(true), 1e-5);
  EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), 1e-5);
  EXPECT_EQ(matrix.space.abs().maxCoeff(), 0);
  EXPECT_LE(matrix.error.maxCoeff(), 1e-5);
  const RowMajorMatrix mutual = matrix.area.matrix().asDiagonal() * matrix.factors;
  EXPECT_LT((mutual - mutual.transpose()).cwiseAbs().maxCoeff(), 1e-15);
  const FactorMatrix empty = factors(test::l_room(false), 1e-8);
  EXPECT_LT((empty.row_sum - 1).abs().maxCoeff(), 1e-8);
}

/// A room of 2 × 2 × 1.2 with boxes, some turned, some standing on the floor.
Scene room_with_boxes(int count, std::uint64_t seed) {
  test::Random random(seed);
  test::SceneMaker maker;
  const Vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 1.2), o = Vec3::Zero();
  for (const Polygon& side : {rectangle(o, x, y), rectangle(o, z, x), rectangle(o, y, z),
                              rectangle(z, y, x), rectangle(y, x, z), rectangle(x, z, y)})
    maker.polygon(side);
  for (int b = 0; b < count; ++b) {
    const Vec3 low(.25 + b % 2 + random(0, .1), .25 + b / 2 + random(0, .1),
                   b % 2 == 0 ? random(.1, .3) : 0);
    const Vec3 high = low + Vec3(random(.2, .4), random(.2, .4), random(.2, .6));
    if (b % 2 == 1)
      maker.standing_box(low, high);
    else
      maker.turned_box(low, high, random(0, 1));
  }
  return maker.scene;
}

TEST(FactorMatrix, RowsOfRoomsWithBoxesSumToOne) {
  for (int count = 1; count <= 3; ++count) {
    const double tolerance = count == 1 ? 1e-4 : 1e-3;
    const FactorMatrix matrix =
        factors(room_with_boxes(count, static_cast<std::uint64_t>(count)), tolerance);
    EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), tolerance) << count;
    // The floor below boxes that stand sees their backs from inside, and nothing else is lost.
    EXPECT_LT((matrix.space - matrix.backs).abs().maxCoeff(), tolerance) << count;
    EXPECT_EQ(matrix.report.rows_not_reached, 0) << count;
  }
}

/// Points that see a box do not see that a strip right above them hides all between them.
TEST(FactorMatrix, StripsBetweenPointsAreFound) {
  for (const double height : {6.6e-4, 1e-5}) {
    test::SceneMaker maker;
    maker.up({0, 0}, {1, 1}, 0).down({-0.19, -0.19}, {0.81, 0.81}, 1);
    maker.up({0, 0.9335}, {0.926, 0.9518}, height);
    maker.turned_box({0.43, 0.48, 0.52}, {0.58, 0.53, 0.68}, 0.3);
    const FactorMatrix matrix = factors(maker.scene, 0.01);
    EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), 0.005) << height;
  }
}

TEST(FactorMatrix, RowsOfAnOpenSceneSumToOneWithSpaceFoundOnItsOwn) {
  const FactorMatrix matrix = factors(test::table_scene(), 1e-5);
  EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), 1e-5);
  EXPECT_GT(matrix.space.minCoeff(), 0.5);
  // The table looks up; the floor sees its back.
  const double back =
      test::offset_parallel_rectangles({-1, 1}, {-1, 1}, {-.25, .25}, {-.25, .25}, 1);
  EXPECT_NEAR(matrix.backs[0], back, 1e-6);
  EXPECT_EQ(matrix.backs[1], 0);
  const FactorMatrix one = factors(scene_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), 1e-8);
  EXPECT_NEAR(one.space[0], 1, 1e-8);
}

// What the floor sees of the box round the scene ends in corners, where nearly nothing is seen.
TEST(FactorMatrix, SpaceIsWhatIsSeenThroughAnOpening) {
  const auto box = test::box_faces({0, 0, 0}, {2, 1, 1.5}, true);
  const FactorMatrix open = factors(scene_of({box.begin(), box.end() - 1}), 1e-8);
  const double ends = test::perpendicular_rectangles(1, 1.5, 2),
               sides = test::perpendicular_rectangles(2, 1.5, 1),
               floor = test::opposed_rectangles(2, 1, 1.5);
  const double expected[] = {ends, ends, sides, sides, floor};
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_LE(open.error[i], 1e-8);
    EXPECT_NEAR(open.space[i], expected[i], open.error[i]) << i;
    EXPECT_NEAR(open.row_sum[i], 1, open.error[i]) << i;
  }
}

TEST(FactorMatrix, FacesGroupsAndMaterials) {
  Scene scene = test::room({2, 1, 1}, {});
  scene.groups = {"sides", "bottom", "top", "nothing"};
  scene.faces[4].group = 1;
  scene.faces[5].group = 2;
  const FactorMatrix faces = factors(scene, 1e-8);
  const FactorMatrix groups = factors(scene, 1e-8, FactorUnit::group);
  ASSERT_EQ(groups.names, (std::vector<std::string>{"sides", "bottom", "top"}));
  EXPECT_EQ(faces.names.front(), "face 1");
  EXPECT_NEAR(groups.area[0], 6, 1e-12);
  const double to_bottom = faces.area.head(4).matrix().dot(faces.factors.col(4).head(4)) / 6;
  EXPECT_NEAR(groups.factors(0, 1), to_bottom, 1e-9);
  const auto sides = faces.factors.topLeftCorner(4, 4);
  EXPECT_NEAR(groups.factors(0, 0), (faces.area.head(4).matrix().asDiagonal() * sides).sum() / 6,
              1e-9);
  EXPECT_EQ(factors(scene, 1e-4, FactorUnit::material).names[2], "m2");
}

TEST(FactorMatrix, CoplanarNeighboursAreFacesOfTheirOwn) {
  Scene scene = plates(1);
  Scene halves;
  const int material = test::add_material(halves, 0.5, 0);
  test::add_polygon(halves, rectangle({0, 0, 0}, {.5, 0, 0}, {0, 1, 0}), material);
  test::add_polygon(halves, rectangle({.5, 0, 0}, {.5, 0, 0}, {0, 1, 0}), material);
  test::add_polygon(halves, rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}), material);
  const FactorMatrix whole = factors(scene, 1e-6), matrix = factors(halves, 1e-6);
  ASSERT_EQ(matrix.names.size(), 3u);
  EXPECT_NEAR(matrix.factors(2, 0) + matrix.factors(2, 1), whole.factors(1, 0), 1e-8);
  EXPECT_EQ(factors(halves, 1e-3, FactorUnit::material).names.size(), 1u);
}

TEST(FactorMatrix, BothSidesOfTwoSidedFacesHaveRows) {
  Scene scene = scene_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                          rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}),
                          rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0})});
  scene.materials[1].two_sided = true;
  const FactorMatrix matrix = factors(scene, 1e-5);
  ASSERT_EQ(matrix.names, (std::vector<std::string>{"face 1", "face 2", "face 2 back", "face 3"}));
  EXPECT_NEAR(matrix.factors(0, 2), test::opposed_rectangles(1, 1, 1), 1e-6);
  EXPECT_NEAR(matrix.factors(1, 3), test::opposed_rectangles(1, 1, 1), 1e-6);
  EXPECT_EQ(matrix.factors(0, 1), 0);
  EXPECT_LE(matrix.factors(0, 3), matrix.error[0]) << "the sheet hides all of it";
}

TEST(FactorMatrix, TheNumberOfThreadsChangesNothing) {
  const FactorMatrix many = factors(test::l_room(true), 1e-3);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const FactorMatrix single = factors(test::l_room(true), 1e-3);
  EXPECT_TRUE((many.factors.array() == single.factors.array()).all());
  EXPECT_TRUE((many.error == single.error).all());
}

TEST(FactorMatrix, RaysAgreeWithinTheirErrors) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.method = FactorMethod::rays;
  options.rays = 30000;
  for (const Scene& scene : {test::l_room(true), test::table_scene()}) {
    const FactorMatrix sampled = form_factor_matrix(scene, options);
    const FactorMatrix exact = factors(scene, 1e-4);
    EXPECT_GE(sampled.report.rays, 30000u * sampled.names.size());
    EXPECT_LT((sampled.row_sum - 1).abs().maxCoeff(), 0.03);
    test::expect_within_errors(sampled, exact);
  }
}

TEST(FactorMatrix, HemicubesAgreeWithinTheirErrors) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.method = FactorMethod::hemicube;
  options.hemicube_pixels = 32;
  options.rays = 50000;
  const Scene scene = test::l_room(true);
  const FactorMatrix seen = form_factor_matrix(scene, options);
  const FactorMatrix exact = factors(scene, 1e-4);
  EXPECT_GE(seen.report.rays, 50000u * seen.names.size());
  EXPECT_LT((seen.row_sum - 1).abs().maxCoeff(), 0.05);
  EXPECT_LT(seen.error.maxCoeff(), 0.15);
  test::expect_within_errors(seen, exact);
}

TEST(FactorMatrix, EnforcedRowsSumToOne) {
  FactorOptions options;
  options.tolerance = 1e-3;
  options.enforce = true;
  options.unit = FactorUnit::face;
  for (const Scene& scene : {test::l_room(true), test::table_scene()}) {
    const FactorMatrix matrix = form_factor_matrix(scene, options);
    ASSERT_TRUE(matrix.report.is_enforced);
    EXPECT_LT((matrix.factors.rowwise().sum().array() + matrix.space - 1).abs().maxCoeff(), 1e-12);
    EXPECT_GE(matrix.factors.minCoeff(), 0);
    EXPECT_GT(matrix.report.enforced_by, 0);
    EXPECT_LT(matrix.report.enforced_by, 2e-2);
    const RowMajorMatrix mutual = matrix.area.matrix().asDiagonal() * matrix.factors;
    EXPECT_LT((mutual - mutual.transpose()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(FactorMatrix, SmallFactorsAreLeftOutWithABound) {
  const FactorMatrix all = factors(test::l_room(true), 1e-4);
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.tolerance = 1e-4;
  options.sparse_below = 0.01;
  const FactorMatrix sparse = form_factor_matrix(test::l_room(true), options);
  EXPECT_GT(sparse.report.left_out, 10u);
  for (Eigen::Index i = 0; i < all.area.size(); ++i)
    for (Eigen::Index j = 0; j < all.area.size(); ++j) {
      const bool is_left_out = sparse.factors(i, j) != all.factors(i, j);
      if (!is_left_out) continue;
      EXPECT_EQ(sparse.factors(i, j), 0);
      EXPECT_LT(all.factors(i, j), options.sparse_below);
      EXPECT_GE(sparse.error[i], all.factors(i, j));
    }
  EXPECT_TRUE((sparse.row_sum == all.row_sum).all());
}

/// The box of the surroundings has one, but nobody asks for that.
TEST(FactorMatrix, FacesWithoutAnAreaAreRefused) {
  Scene scene;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, test::add_material(scene, 0.5, 0));
  test::expect_error([&] { test::face_factors(scene, 1e-4); }, ErrorCode::invalid_input,
                     {"none of its 1 faces has an area"});
}

TEST(FactorMatrix, StoppedItIsNotComplete) {
  std::stop_source stop;
  stop.request_stop();
  const Progress progress{stop.get_token(), {}};
  for (const FactorMethod method :
       {FactorMethod::exact, FactorMethod::rays, FactorMethod::hemicube}) {
    FactorOptions options;
    options.method = method;
    const FactorMatrix matrix = form_factor_matrix(test::l_room(true), options, progress);
    EXPECT_FALSE(matrix.report.is_complete);
    EXPECT_EQ(matrix.factors.size(), 0);
  }
}

TEST(FactorMatrix, PairsThatTakeTooManyPointsSaySo) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.tolerance = 1e-7;
  options.max_points = 200;
  const FactorMatrix matrix = form_factor_matrix(test::table_scene(), options);
  EXPECT_GT(matrix.report.rows_not_reached, 0);
  EXPECT_GT(matrix.error.maxCoeff(), options.tolerance);
  EXPECT_LT((matrix.row_sum - 1).abs().maxCoeff(), 9 * matrix.error.maxCoeff());
}

}  // namespace
}  // namespace halfshade
