#include "solver/factors/saved_factors.h"

#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A box from inside without its lid, two faces a group, and a plate in it.
Scene open_box() {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 0);
  const int other = test::add_material(scene, 0.2, 0);
  scene.materials[static_cast<std::size_t>(other)].two_sided = true;
  const auto add = [&](const std::vector<Vec3>& corners, int of, const char* group) {
    test::add_polygon(scene, corners, of);
    const auto known = std::find(scene.groups.begin(), scene.groups.end(), group);
    const auto id = static_cast<int>(known - scene.groups.begin());
    if (known == scene.groups.end()) scene.groups.emplace_back(group);
    scene.faces.back().group = id;
  };
  add({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, material, "floor");
  add({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, material, "ends");
  add({{2, 0, 0}, {2, 0, 1}, {2, 1, 1}, {2, 1, 0}}, material, "ends");
  add({{0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, 0}}, other, "sides");
  add({{0, 1, 0}, {2, 1, 0}, {2, 1, 1}, {0, 1, 1}}, material, "sides");
  add({{.7, .3, .5}, {1.2, .3, .5}, {1.2, .6, .5}, {.7, .6, .5}}, other, "plate");
  return scene;
}

FactorMatrix computed(const Scene& scene, FactorUnit unit, double tolerance = 1e-2) {
  FactorOptions options;
  options.unit = unit;
  options.tolerance = tolerance;
  return form_factor_matrix(scene, options);
}

TEST(SavedFactors, SumsAreTheMatrixOfGroups) {
  const Scene scene = open_box();
  const double tolerance = 1e-3;
  const FactorMatrix faces = computed(scene, FactorUnit::face, tolerance);
  for (const FactorUnit unit : {FactorUnit::group, FactorUnit::material, FactorUnit::face}) {
    FactorOptions options;
    options.unit = unit;
    const FactorMatrix sums = summed_factors(scene, faces, options);
    const FactorMatrix direct = computed(scene, unit, tolerance);
    EXPECT_EQ(sums.names, direct.names);
    EXPECT_TRUE(sums.area.isApprox(direct.area, 1e-14));
    EXPECT_LT((sums.factors - direct.factors).cwiseAbs().maxCoeff(), 2 * tolerance);
    EXPECT_LT((sums.space - direct.space).abs().maxCoeff(), 2 * tolerance);
    EXPECT_LT((sums.row_sum - 1).abs().maxCoeff(), 2 * tolerance);
    for (Eigen::Index i = 0; i < sums.area.size(); ++i)
      EXPECT_LE((sums.factors.row(i) - direct.factors.row(i)).cwiseAbs().maxCoeff(),
                sums.error[i] + direct.error[i]);
  }
}

TEST(SavedFactors, SumsCanBeEnforced) {
  const Scene scene = open_box();
  FactorOptions options;
  options.enforce = true;
  const FactorMatrix sums = summed_factors(scene, computed(scene, FactorUnit::face), options);
  EXPECT_TRUE(sums.report.is_enforced);
  const Eigen::ArrayXd rows = sums.factors.rowwise().sum().array() + sums.space;
  EXPECT_LT((rows - 1).abs().maxCoeff(), 1e-12);
}

TEST(SavedFactors, SumsTellWhatWasLeftOutOfThem) {
  const Scene scene = open_box();
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.sparse_below = 0.1;
  FactorMatrix faces = form_factor_matrix(scene, options);
  EXPECT_GT(faces.report.left_out_max, 0.05);
  EXPECT_EQ(faces.report.left_out_max, faces.left_out.maxCoeff());
  EXPECT_NO_THROW(require_rows_that_add_up(faces));
  for (int k = 0; k < 2; ++k) {
    const FactorMatrix sums = summed_factors(scene, faces, {});
    const Eigen::ArrayXd rows = sums.factors.rowwise().sum().array() + sums.space;
    EXPECT_LT((rows + sums.left_out - sums.row_sum).abs().maxCoeff(), 1e-12);
    EXPECT_GT(sums.left_out.maxCoeff(), 0.01);
    faces.left_out.resize(0);  // as files tell it that were written without
  }
}

TEST(SavedFactors, WhatWasLeftOutIsMadeUpForByEnforcedRows) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.sparse_below = 0.1;
  options.enforce = true;
  const FactorMatrix faces = form_factor_matrix(open_box(), options);
  EXPECT_TRUE(faces.report.is_enforced);
  EXPECT_GT(faces.report.left_out, 2u);
  EXPECT_GT(faces.report.left_out_max, 0.05);
  EXPECT_EQ(faces.left_out.maxCoeff(), 0);
  const Eigen::ArrayXd rows = faces.factors.rowwise().sum().array() + faces.space;
  EXPECT_LT((rows - 1).abs().maxCoeff(), 1e-12);
  const FactorMatrix all = computed(open_box(), FactorUnit::face, 1e-4);
  for (Eigen::Index i = 0; i < all.area.size(); ++i)
    EXPECT_LE((faces.factors.row(i) - all.factors.row(i)).cwiseAbs().maxCoeff(),
              faces.error[i] + all.error[i]);
}

/// That faces saved with one scene are refused for another.
void expect_refused(const Scene& saved, const Scene& scene, const std::vector<std::string>& parts) {
  test::expect_error([&] { summed_factors(scene, computed(saved, FactorUnit::face), {}); },
                     ErrorCode::invalid_input, parts);
}

TEST(SavedFactors, RefuseFacesThatMovedOrTurned) {
  const Scene scene = open_box();
  const auto with_plate = [&](const std::vector<Vec3>& corners) {
    Scene other = scene;
    std::copy(corners.begin(), corners.end(), other.vertices.end() - 4);
    return other;
  };
  const Scene square = with_plate({{.7, .3, .5}, {1.1, .3, .5}, {1.1, .7, .5}, {.7, .7, .5}});
  const double d = 0.2 * std::sqrt(2.);
  Scene moved = scene, a_bit = scene, off = scene;
  for (auto p = moved.vertices.end() - 4; p != moved.vertices.end(); ++p) p->x() += .1;
  for (auto p = a_bit.vertices.end() - 4; p != a_bit.vertices.end(); ++p) p->z() += 1e-7;
  for (auto p = off.vertices.end() - 4; p != off.vertices.end(); ++p) p->z() *= 1 + 1e-14;
  expect_refused(scene, moved,
                 {"'face 6'", "centre at (0.95,", "(1.05,", "do not belong together"});
  expect_refused(scene, a_bit, {"'face 6'", "centre"});
  expect_refused(scene, with_plate({{.7, .6, .5}, {1.2, .6, .5}, {1.2, .3, .5}, {.7, .3, .5}}),
                 {"'face 6'", "faces the way (0, 0, 1)", "(0, 0, -1)"});
  expect_refused(scene,
                 with_plate({{.95, .45, .25}, {1.1, .45, .25}, {1.1, .45, .75}, {.95, .45, .75}}),
                 {"'face 6'", "do not belong together"});
  expect_refused(
      square, with_plate({{.9 - d, .5, .5}, {.9, .5 - d, .5}, {.9 + d, .5, .5}, {.9, .5 + d, .5}}),
      {"'face 6'", "is turned", "(0.4, 0.4, 0)", "(0.565685425, 0.565685425, 0)"});
  EXPECT_NO_THROW(summed_factors(off, computed(scene, FactorUnit::face), {}));
}

TEST(SavedFactors, RefuseWhatDoesNotBelongTogether) {
  const Scene scene = open_box();
  FactorMatrix faces = computed(scene, FactorUnit::face);
  faces.source = "f.mtx";
  const auto refused = [](const Scene& of, const FactorMatrix& matrix,
                          const std::vector<std::string>& parts) {
    test::expect_error([&] { summed_factors(of, matrix, {}); }, ErrorCode::invalid_input, parts);
  };
  Scene fewer = scene;
  fewer.faces.pop_back();
  refused(fewer, faces, {"f.mtx", "8 rows", "6 faces"});
  Scene larger = scene;
  larger.vertices[2].y() = 1.5;
  refused(larger, faces, {"f.mtx", "'face 1'", "area of 2 ", "2.5"});
  FactorMatrix of_groups = computed(scene, FactorUnit::group);
  of_groups.source = "g.mtx";
  refused(scene, of_groups, {"g.mtx", "by face"});
  FactorMatrix renamed = faces;
  renamed.names[1] = "ends";
  refused(scene, renamed, {"row 2", "'ends'", "'face 2'"});
  FactorMatrix one_way = faces;
  one_way.factors(0, 1) += 1e-3;
  refused(scene, one_way, {"'face 2'", "'face 1'", "not reciprocal"});
}

}  // namespace
}  // namespace halfshade
