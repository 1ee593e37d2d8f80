#include "solver/factors/error_shares.h"

#include "solver/factors/factor_matrix.h"
#include "tests/support/face_factors.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// One row of ten surfaces, each of which sees the surroundings past something.
struct OneRow {
  static constexpr int count = 10;
  FactorScene scene;
  std::vector<std::vector<SightPair>> pairs;

  OneRow() {
    scene.names = {"all"};
    scene.areas = {2};
    scene.row.assign(count, 0);
    scene.row.push_back(surroundings);
    for (int k = 0; k < count; ++k) pairs.push_back({{count, Sight::partial, {}}});
    pairs.emplace_back();
  }
};

TEST(ErrorShares, WhatIsLeftGoesToThoseThatNeedIt) {
  const OneRow row;
  ErrorShares shares(row.scene, row.pairs, 1e-3);
  const double all = 2e-3, even = shares.even_share(0, surroundings);
  ASSERT_TRUE(shares.is_shared(0, surroundings));
  JointError joint;
  for (int k = 0; k < OneRow::count; ++k) joint.add(even);
  EXPECT_DOUBLE_EQ(joint.bound(), all);
  EXPECT_DOUBLE_EQ(shares.joint_share(0, surroundings, OneRow::count), all);
  joint = {};
  for (int k = 0; k < OneRow::count - 3; ++k) {
    shares.spend(0, surroundings, 0.1 * even);
    joint.add(0.1 * even);
  }
  const std::array<double, 3> needs = {1, 4, 0.01};
  for (const double need : needs) shares.claim(0, surroundings, need);
  double before = 0;
  for (const double need : {0.01, 1., 4.}) {
    const double share = shares.share(0, surroundings, need);
    EXPECT_GT(share, even);
    EXPECT_GT(share, before);
    before = share;
    joint.add(share);
  }
  EXPECT_LE(joint.bound(), all * (1 + 1e-12));
  EXPECT_GT(joint.bound(), 0.9 * all);
}

/// One claims as much as it is, few hardly less than their sum, and copies that are off by a tenth
/// of what they claim, all in the same way, are within what they claim together.
TEST(ErrorShares, ClaimsOfAnEntryAddUp) {
  JointError joint;
  EXPECT_EQ(joint.bound(), 0);
  joint.add(3);
  EXPECT_DOUBLE_EQ(joint.bound(), 3);
  joint.add(3);
  EXPECT_GT(joint.bound(), 5);
  EXPECT_LT(joint.bound(), 6);
  JointError copies;
  double sum = 0;
  for (int k = 0; k < 9999; ++k, sum += 0.1) copies.add(1);
  EXPECT_GT(copies.bound(), sum);
  EXPECT_LT(copies.bound(), sum * 1.01);
}

/// Whoever spent more than was allowed takes nothing from the others.
TEST(ErrorShares, NoPairGetsLessThanItsEvenShare) {
  const OneRow row;
  ErrorShares shares(row.scene, row.pairs, 1e-3);
  shares.spend(0, surroundings, 1);
  shares.claim(0, surroundings, 2);
  EXPECT_DOUBLE_EQ(shares.share(0, surroundings, 2), shares.even_share(0, surroundings));
}

/// What two surfaces of a row see of each other counts for both, and so does what it is off by.
TEST(ErrorShares, PairsWithinARowCountTwice) {
  OneRow row;
  const std::size_t pairs = row.pairs.size() - 2;
  for (std::size_t k = 0; k < pairs; ++k) row.pairs[k] = {{OneRow::count - 1, Sight::partial, {}}};
  row.pairs[pairs].clear();
  ErrorShares shares(row.scene, row.pairs, 1e-3);
  JointError joint;
  for (std::size_t k = 0; k < pairs; ++k) joint.add(2 * shares.even_share(0, 0));
  EXPECT_NEAR(joint.bound(), 2e-3, 1e-15);
}

/// The side of a cylinder round the z axis.
void add_side(Scene& scene, double radius, int faces, bool inwards) {
  const auto corner = [&](int k, double z) {
    const double angle = 2 * std::numbers::pi * k / faces;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int k = 0; k < faces; ++k) {
    std::vector<Vec3> face = {corner(k, 0), corner(k + 1, 0), corner(k + 1, 3), corner(k, 3)};
    if (inwards) std::reverse(face.begin(), face.end());
    test::add_polygon(scene, face, inwards ? 1 : 0);
  }
}

/// Two open cylinders, one in the other, by material: of some hundred pairs of an entry most see
/// nothing, and leave what they may be off by to those that do. (When all had as much, 4.4 million
/// points were looked at; when claims were added, 360,000.)
TEST(ErrorShares, GroupsOfManyFacesTakeFewPoints) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  test::add_material(scene, 0.5, 0);
  add_side(scene, 1, 16, false);
  add_side(scene, 2, 16, true);
  FactorOptions options;
  options.unit = FactorUnit::material;
  const FactorMatrix matrix = form_factor_matrix(scene, options);
  EXPECT_LT(matrix.report.points, 200000u);
  EXPECT_EQ(matrix.report.rows_not_reached, 0);
  EXPECT_LT(matrix.report.row_sum_error_max, 2e-5);
  EXPECT_LT(matrix.error.maxCoeff(), options.tolerance);
}

/// Boxes in rows in a room: what walls see of each other past all of them has kinks everywhere.
Scene boxes_in_a_room() {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  test::add_material(scene, 0.5, 0);
  for (const auto& face : test::box_faces(Vec3::Zero(), {5, 5, 3}, true))
    test::add_polygon(scene, face, 0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec3 low(0.6 + 1.1 * i, 0.6 + 1.1 * j, 0.3);
      const Vec3 size(0.4, 0.4, 0.4 + 0.3 * ((3 * i + j) % 4));
      for (const auto& face : test::box_faces(low, low + size, false))
        test::add_polygon(scene, face, 1);
    }
  return scene;
}

/// (When claims were added, and cells of walls went on to 100,000 points before lattices were
/// tried, 4.1 million points were looked at.)
TEST(ErrorShares, WallsPastManyBoxes) {
  FactorOptions options;
  options.unit = FactorUnit::material;
  options.method = FactorMethod::exact;
  options.tolerance = 1e-5;
  const FactorMatrix fine = form_factor_matrix(boxes_in_a_room(), options);
  EXPECT_LT(fine.report.points, 450000u);
  EXPECT_EQ(fine.report.rows_not_reached, 0);
  EXPECT_LT(fine.report.row_sum_error_max, 1e-6);
  options.tolerance = 1e-3;
  const FactorMatrix coarse = form_factor_matrix(boxes_in_a_room(), options);
  EXPECT_LT(coarse.report.points, 25000u);
  EXPECT_LT(coarse.report.row_sum_error_max, 1e-4);
  test::expect_within_errors(coarse, fine);
}

}  // namespace
}  // namespace halfshade
