#include "meshing/backprojection/edge_sum.h"

#include "tests/support/analytic.h"
#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

using test::LitScene;
using test::Random;
using test::SceneMaker;

const Vec3 z_axis = Vec3::UnitZ();

TEST(EnclosedFactor, OfAParallelRectangleIsTheClosedForm) {
  for (const auto& [a, b, c] : {std::array{1., 1., 2.}, {0.3, 2., 0.7}, {5., 0.1, 1.}}) {
    const LitScene lit(SceneMaker().down({0, 0}, {a, b}, c, test::white_light));
    EXPECT_NEAR(lit.factor(Vec3::Zero(), z_axis), test::point_parallel_rectangle(a, b, c), 1e-13);
    EXPECT_EQ(lit.factor(Vec3::Zero(), -z_axis), 0);
  }
}

TEST(EnclosedFactor, OfAWallIsTheClosedFormAndItsPartBelowTheHorizonDoesNotCount) {
  for (const auto& [a, b, c] : {std::array{1., 1., 2.}, {0.3, 2., 0.7}, {2., 0.5, 1.}})
    for (const double low : {0., -0.4, -3.}) {
      const LitScene lit(SceneMaker().polygon({{c, 0, low}, {c, 0, a}, {c, b, a}, {c, b, low}},
                                              test::white_light));
      EXPECT_NEAR(lit.factor(Vec3::Zero(), z_axis), test::point_perpendicular_rectangle(a, b, c),
                  1e-13);
    }
}

TEST(EnclosedFactor, BehindAnOccluderIsTheRest) {
  // The occluder at half height hides [0,.6] × [0,.4] of the light.
  const LitScene lit(
      SceneMaker().down({0, 0}, {1, 1}, 2, test::white_light).up({-0.5, -0.7}, {0.3, 0.2}, 1));
  const double expected =
      test::point_parallel_rectangle(1, 1, 2) - test::point_parallel_rectangle(0.6, 0.4, 2);
  EXPECT_NEAR(lit.factor(Vec3::Zero(), z_axis), expected, 1e-13);
}

TEST(EnclosedFactor, OfPiecesDoesNotDependOnWhereTheyLieOnTheirRays) {
  Random random(1);
  const std::vector<Vec3> corners = {{-1, 0, 2}, {0, 1.5, 2}, {1, 0.5, 2}};  // clockwise from above
  for (int round = 0; round < 50; ++round) {
    std::vector<BoundaryPiece> plain, scaled;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      plain.push_back({a, b, EdgeId::edge(0)});
      scaled.push_back({random(0.2, 3) * a, random(0.2, 3) * b, EdgeId::edge(0)});
    }
    const double factor = enclosed_factor(Vec3::Zero(), z_axis, plain);
    EXPECT_GT(factor, 0);
    EXPECT_NEAR(enclosed_factor(Vec3::Zero(), z_axis, scaled), factor, 1e-14);
  }
  EXPECT_EQ(enclosed_factor(Vec3::Zero(), z_axis, {}), 0);
}

}  // namespace
}  // namespace halfshade
