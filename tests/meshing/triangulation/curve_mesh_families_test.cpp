#include "tests/support/curve_families.h"
#include "tests/support/curve_invariants.h"
#include "tests/support/curve_mesh_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <tuple>
#include <vector>

// What holds for every family of lines that is hard on a mesher.

namespace halfshade::test {
namespace {

class CurveMeshFamily : public testing::TestWithParam<std::tuple<const char*, unsigned>> {
 protected:
  std::vector<CurvePolyline> lines(int n) const {
    return LineFamily(std::get<0>(GetParam()), std::get<1>(GetParam())).make(n);
  }
};

TEST_P(CurveMeshFamily, UnrefinedMeshIsSoundAndFollowsTheLines) {
  const auto given = lines(60);
  for (const auto& rings : {square, notched}) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, unrefined());
    expect_sound(mesh, rings);
    expect_follows(mesh, rings, given, 1e-7);
    EXPECT_TRUE(mesh.mesh.complete);
  }
}

TEST_P(CurveMeshFamily, RefinedMeshIsSoundAndFollowsTheLines) {
  const auto given = lines(60);
  CurveMeshOptions options;
  options.quality.max_length = 0.3;
  for (const auto& rings : {square, notched}) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, options);
    expect_sound(mesh, rings);
    expect_follows(mesh, rings, given, 1e-7);
    EXPECT_TRUE(mesh.mesh.complete);
    EXPECT_LE(angle_and_length(mesh.mesh).second, 0.3);
  }
}

TEST_P(CurveMeshFamily, RefinementMakesNoShorterEdgesThanAsked) {
  const auto given = lines(40);
  const CurveMesh coarse = mesh_with_curves(notched, {}, given, unrefined());
  std::set<std::array<double, 2>> there;
  for (const Vec2& p : coarse.mesh.points) there.insert({p.x(), p.y()});
  CurveMeshOptions options;
  options.shortest = 2e-3;
  const CurveMesh mesh = mesh_with_curves(notched, {}, given, options);
  for (const auto& t : mesh.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = place_of(mesh.mesh, {t[k], t[(k + 1) % 3]});
      if (!there.contains({a.x(), a.y()})) {
        EXPECT_GE((b - a).norm(), 2e-3 * (1 - 1e-12));
      }
    }
}

TEST_P(CurveMeshFamily, SameInputSameBytes) {
  const auto given = lines(40);
  const CurveMesh a = mesh_with_curves(notched, {}, given, {});
  const CurveMesh b = mesh_with_curves(notched, {}, given, {});
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.constrained_edges, b.mesh.constrained_edges);
  EXPECT_EQ(a.curves, b.curves);
}

// The border is meant to be meshed again and again until neighbours agree on its points.
TEST_P(CurveMeshFamily, ItsOwnBorderPointsGivenBackHardlyAddAny) {
  const auto given = lines(30);
  std::vector<Ring> rings = square;
  std::size_t before = 0, after = 0;
  for (int round = 0; round < 4; ++round) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, {});
    std::array<std::vector<Vec2>, 4> sides;
    for (const Vec2& p : mesh.mesh.points) {
      if (p.y() == 0 && p.x() < 1) sides[0].push_back(p);
      if (p.x() == 1 && p.y() < 1) sides[1].push_back(p);
      if (p.y() == 1 && p.x() > 0) sides[2].push_back(p);
      if (p.x() == 0 && p.y() > 0) sides[3].push_back(p);
    }
    const std::array<Vec2, 4> onward = {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
    Ring ring;
    for (std::size_t k = 0; k < 4; ++k) {
      std::sort(sides[k].begin(), sides[k].end(),
                [&](const Vec2& a, const Vec2& b) { return a.dot(onward[k]) < b.dot(onward[k]); });
      ring.insert(ring.end(), sides[k].begin(), sides[k].end());
    }
    expect_sound(mesh_with_curves(std::vector<Ring>{ring}, {}, given, {}), {ring});
    before = after;
    after = ring.size();
    if (round == 1) {
      EXPECT_LE(after, before + 2 + before / 20);
    }
    rings = {ring};
  }
  EXPECT_EQ(after, before) << "it settles";
}

INSTANTIATE_TEST_SUITE_P(Families, CurveMeshFamily,
                         testing::Combine(testing::Values("Random", "Concurrent", "NearParallel",
                                                          "AxisAligned", "ConicTangent", "Fan",
                                                          "Offset", "Coincident", "AlongTheBorder"),
                                          testing::Values(1U, 2U, 3U)),
                         [](const auto& name) {
                           return std::get<0>(name.param) + std::to_string(std::get<1>(name.param));
                         });

}  // namespace
}  // namespace halfshade::test
