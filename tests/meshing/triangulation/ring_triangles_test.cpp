#include "meshing/triangulation/ring_triangles.h"

#include "meshing/core/planar.h"
#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

double area_of(const std::vector<Ring>& rings, const Triangles& triangles) {
  std::vector<Vec2> corners;
  for (const Ring& ring : rings) corners.insert(corners.end(), ring.begin(), ring.end());
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const double twice = cross_2d(corners[at(b)] - corners[at(a)], corners[at(c)] - corners[at(a)]);
    EXPECT_GT(twice, 0);
    sum += 0.5 * twice;
  }
  return sum;
}

TEST(RingTriangles, CutConvexQuadrilateralsFromTheirFirstCorner) {
  const std::vector<Ring> quad = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}};
  EXPECT_EQ(ring_triangles(quad), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  const std::vector<Ring> triangle = {{{0, 0}, {2, 0}, {2, 1}}};
  EXPECT_EQ(ring_triangles(triangle), (Triangles{{0, 1, 2}}));
}

TEST(RingTriangles, StayInsideWhereACornerIsReflexOrStraight) {
  const std::vector<Ring> arrow = {{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}};
  EXPECT_NEAR(area_of(arrow, ring_triangles(arrow)), test::area_of(arrow), 1e-15);
  const std::vector<Ring> straight = {{{0, 0}, {1, 0}, {2, 0}, {0, 2}}};
  EXPECT_NEAR(area_of(straight, ring_triangles(straight)), test::area_of(straight), 1e-15);
}

TEST(RingTriangles, NumberCornersThroughAllRings) {
  const std::vector<Ring> frame = {{{0, 0}, {3, 0}, {3, 3}, {0, 3}},
                                   {{1, 1}, {1, 2}, {2, 2}, {2, 1}}};
  const Triangles triangles = ring_triangles(frame);
  EXPECT_EQ(triangles.size(), 8u);
  EXPECT_NEAR(area_of(frame, triangles), 8, 1e-15);
}

TEST(RingTriangles, AreNoneWithoutThreeCorners) {
  EXPECT_TRUE(ring_triangles(std::vector<Ring>{{{0, 0}, {1, 0}}}).empty());
}

}  // namespace
}  // namespace halfshade
