#include "meshing/triangulation/planar_mesh.h"

#include "tests/support/mesh_invariants.h"
#include "tests/support/rings.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

using test::expect_sound;
using test::square_hole;
using test::unit_square;

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

}  // namespace
}  // namespace halfshade
