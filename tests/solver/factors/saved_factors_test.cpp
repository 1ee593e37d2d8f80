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
