#include "meshing/triangulation/planar_mesh.h"

#include "meshing/core/error.h"
#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace halfshade {
namespace {

using test::angle_and_length;
using test::expect_sound;

const Ring unit_square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Ring square_hole = {{0.4, 0.4}, {0.4, 0.6}, {0.6, 0.6}, {0.6, 0.4}};

Ring rectangle(double width, double height) {
  return {{0, 0}, {width, 0}, {width, height}, {0, height}};
}

TEST(Triangulate, AddsNoPoints) {
  const std::vector<Ring> rings = {unit_square, square_hole};
  const PlanarMesh mesh = triangulate(rings, {});
  expect_sound(mesh, rings);
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 8u);  // n + 2h − 2
}

TEST(Triangulate, NonConvexPolygonStaysInside) {
  const std::vector<Ring> rings = {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}};
  const PlanarMesh mesh = triangulate(rings, {});
  expect_sound(mesh, rings);
  EXPECT_EQ(mesh.triangles.size(), 4u);
}

TEST(Triangulate, CrossingContactsGetOneCommonPoint) {
  const std::vector<Ring> rings = {unit_square};
  const std::vector<Segment2> contacts = {{Vec2(0.2, 0.5), Vec2(0.8, 0.5)},
                                          {Vec2(0.5, 0.1), Vec2(0.5, 0.7)}};
  const PlanarMesh mesh = triangulate(rings, contacts);
  expect_sound(mesh, rings, contacts);
  EXPECT_EQ(mesh.points.size(), 9u);
  EXPECT_EQ(mesh.constrained_edges.size(), 8u);
}

TEST(Triangulate, HoleThatTouchesTheBorderInAPointIsLeftOut) {
  const std::vector<Ring> rings = {{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}},
                                   {{1, 0}, {0.5, 1}, {1.5, 1}}};
  double area = 0;
  const PlanarMesh mesh = triangulate(rings, {});
  for (const auto& t : mesh.triangles)
    area += test::signed_area({mesh.points[static_cast<std::size_t>(t[0])],
                               mesh.points[static_cast<std::size_t>(t[1])],
                               mesh.points[static_cast<std::size_t>(t[2])]});
  EXPECT_DOUBLE_EQ(area, 4 - 0.5);
}

class Refinement : public testing::TestWithParam<double> {};

TEST_P(Refinement, ReachesAngleAndLength) {
  const double h = GetParam();
  const std::vector<Ring> rings = {unit_square, square_hole};
  const std::vector<Segment2> contacts = {{Vec2(0.1, 0.1), Vec2(0.3, 0.8)}};
  const PlanarMesh mesh = refine_triangulation(rings, contacts, {.max_length = h});
  expect_sound(mesh, rings, contacts);
  const auto [angle, length] = angle_and_length(mesh);
  EXPECT_GE(angle, 20.7);
  EXPECT_LE(length, h);
  EXPECT_TRUE(mesh.complete);
  // No triangle with edges up to h is larger than the equilateral one.
  EXPECT_GE(static_cast<double>(mesh.triangles.size()), 0.96 / (std::sqrt(3.0) / 4 * h * h));
}

INSTANTIATE_TEST_SUITE_P(Lengths, Refinement, testing::Values(1.0, 0.3, 0.1, 0.03));

TEST(RefineTriangulation, WithoutLimitsLeavesAGoodPolygonAlone) {
  const std::vector<Ring> rings = {unit_square};
  EXPECT_EQ(refine_triangulation(rings, {}, {}).triangles.size(), 2u);
}

TEST(RefineTriangulation, ScalesWithPowersOfTwoExactly) {
  const std::vector<Ring> rings = {unit_square, square_hole};
  const PlanarMesh mesh = refine_triangulation(rings, {}, {.max_length = 0.125});
  for (const double scale : {0x1p-150, 0x1p-20, 0x1p30, 0x1p150}) {
    std::vector<Ring> scaled = rings;
    for (Ring& ring : scaled)
      for (Vec2& p : ring) p *= scale;
    const PlanarMesh other = refine_triangulation(scaled, {}, {.max_length = 0.125 * scale});
    ASSERT_EQ(other.triangles, mesh.triangles) << scale;
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      EXPECT_EQ(other.points[i], scale * mesh.points[i]);
  }
}

TEST(RefineTriangulation, SmallInputAnglesEnd) {
  for (const double degrees : {10.0, 1.0, 0.01}) {
    const double slope = std::tan(degrees * M_PI / 180);
    const std::vector<Ring> rings = {{{0, 0}, {1, 0}, {1, slope}}};
    const PlanarMesh mesh = refine_triangulation(rings, {}, {.max_length = 0.2});
    expect_sound(mesh, rings);
    EXPECT_LE(angle_and_length(mesh).second, 0.2);
    EXPECT_LE(mesh.triangles.size(), 30000u);
  }
}

TEST(RefineTriangulation, ThinPolygonsDoNotExplode) {
  for (const double width : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9}) {
    for (const Ring& ring : {rectangle(1, width), Ring{{0, 0}, {1, 0}, {0.3, width}}}) {
      const PlanarMesh mesh =
          refine_triangulation(std::vector<Ring>{ring}, {}, {.max_length = 0.1});
      expect_sound(mesh, {ring});
      EXPECT_LE(angle_and_length(mesh).second, 0.1);
      EXPECT_LE(mesh.triangles.size(), 20000u) << width;
    }
  }
}

TEST(RefineTriangulation, StopsAtTheTriangleLimitWithASoundMesh) {
  const std::vector<Ring> rings = {unit_square, square_hole};
  const PlanarMesh mesh =
      refine_triangulation(rings, {}, {.max_length = 0.01, .max_triangles = 500});
  EXPECT_FALSE(mesh.complete);
  EXPECT_LE(mesh.triangles.size(), 502u);
  expect_sound(mesh, rings);
}

TEST(RefineTriangulation, RandomStarsWithContactsAreSound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 25; ++trial) {
    Ring star;
    const int n = 5 + trial;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * M_PI * (k + 0.5 * uniform(random)) / n;
      const double radius = 0.5 + uniform(random);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    std::vector<Segment2> contacts;
    for (int k = 0; k < 3; ++k)
      contacts.push_back({0.3 * Vec2(uniform(random) - 0.5, uniform(random) - 0.5),
                          0.3 * Vec2(uniform(random) - 0.5, uniform(random) - 0.5)});
    const PlanarMesh mesh =
        refine_triangulation(std::vector<Ring>{star}, contacts, {.max_length = 0.2});
    expect_sound(mesh, {star}, contacts);
    EXPECT_LE(angle_and_length(mesh).second, 0.2);
  }
}

TEST(RefineTriangulation, RejectsOptionsOutOfRange) {
  const std::vector<Ring> rings = {unit_square};
  for (const PlanarMeshOptions& options :
       {PlanarMeshOptions{.max_length = -1}, PlanarMeshOptions{.max_length = NAN},
        PlanarMeshOptions{.min_angle = 30}, PlanarMeshOptions{.min_angle = -1}}) {
    try {
      refine_triangulation(rings, {}, options);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::contract);
    }
  }
}

}  // namespace
}  // namespace halfshade
