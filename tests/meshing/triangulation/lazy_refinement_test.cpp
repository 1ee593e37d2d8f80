#include "meshing/triangulation/lazy_refinement.h"

#include "meshing/geometry/planar_signs.h"
#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>

#include <random>

namespace halfshade::test {
namespace {

// A triangulation with given points and triangles; sides at the border are constraints 0, 1, 2…,
// given inner sides go on from there.
ConstrainedMesh make(const std::vector<Vec2>& points,
                     const std::vector<std::array<int, 3>>& triangles,
                     const std::vector<std::array<int, 2>>& inner = {}) {
  ConstrainedMesh mesh;
  mesh.points = points;
  std::map<std::pair<int, int>, int> beside;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      beside[{triangles[t][k], triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
  int lines = 0;
  std::map<std::pair<int, int>, int> line;
  for (const auto& [side, t] : beside)
    if (!beside.contains({side.second, side.first})) line[side] = lines++;
  for (const auto& [a, b] : inner) line[{a, b}] = line[{b, a}] = lines++;
  for (const auto& corner : triangles) {
    auto& t = mesh.triangles.emplace_back();
    t.corner = corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corner[k], b = corner[(k + 1) % 3];
      t.neighbour[k] = beside.contains({b, a}) ? beside[{b, a}] : -1;
      t.constraint[k] = line.contains({a, b}) ? line[{a, b}] : -1;
    }
  }
  return mesh;
}

ConstrainedMesh square() { return make({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}); }

PlanarMesh plain(const ConstrainedMesh& mesh) {
  PlanarMesh result;
  result.points = mesh.points;
  for (const auto& t : mesh.triangles) result.triangles.push_back(t.corner);
  return result;
}

void expect_delaunay_and_linked(const ConstrainedMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    EXPECT_GT(
        orientation(mesh.point(t.corner[0]), mesh.point(t.corner[1]), mesh.point(t.corner[2])), 0);
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.neighbour[k] < 0) {
        EXPECT_GE(t.constraint[k], 0);
        continue;
      }
      const auto& other = mesh.triangle(t.neighbour[k]);
      std::size_t back = 0;
      while (back < 3 && other.neighbour[back] != static_cast<int>(i)) ++back;
      ASSERT_LT(back, 3U);
      EXPECT_EQ(other.corner[back], t.corner[(k + 1) % 3]);
      EXPECT_EQ(other.corner[(back + 1) % 3], t.corner[k]);
      EXPECT_EQ(other.constraint[back], t.constraint[k]);
      if (t.constraint[k] < 0) {
        EXPECT_LE(in_circle(mesh.point(t.corner[0]), mesh.point(t.corner[1]),
                            mesh.point(t.corner[2]), mesh.point(other.corner[(back + 2) % 3])),
                  0);
      }
    }
  }
}

TEST(LazyRefinement, LeavesGoodTrianglesAlone) {
  ConstrainedMesh mesh = square();
  EXPECT_TRUE(refine_lazily(mesh, {0, 20.7, 1e-3, 1000}));
  EXPECT_EQ(mesh.triangles.size(), 2U);
}

class LazyRefinementLength : public testing::TestWithParam<double> {};

TEST_P(LazyRefinementLength, IsKeptWithGoodAngles) {
  ConstrainedMesh mesh = square();
  EXPECT_TRUE(refine_lazily(mesh, {GetParam(), 20.7, 1e-4, 100000}));
  const auto [angle, length] = angle_and_length(plain(mesh));
  EXPECT_LE(length, GetParam());
  EXPECT_GE(angle, 20.699);
  // Not far from the fewest that could do: an equilateral triangle has √3/4 of its side squared.
  EXPECT_LE(static_cast<double>(mesh.triangles.size()), 12 / (GetParam() * GetParam()));
  expect_delaunay_and_linked(mesh);
}

INSTANTIATE_TEST_SUITE_P(Lengths, LazyRefinementLength, testing::Values(0.9, 0.31, 0.1, 0.033));

TEST(LazyRefinement, DividesLongConstraintsIntoEqualParts) {
  ConstrainedMesh mesh = square();
  refine_lazily(mesh, {0.07, 20.7, 1e-4, 100000});
  int on_border = 0;
  for (const Vec2& p : mesh.points) {
    const bool is_horizontal = p.y() == 0 || p.y() == 1, is_vertical = p.x() == 0 || p.x() == 1;
    if (!is_horizontal && !is_vertical) continue;
    ++on_border;
    const double along = 15 * (is_horizontal ? p.x() : p.y());
    EXPECT_NEAR(along, std::round(along), 1e-14);
  }
  EXPECT_EQ(on_border, 60) << "1/15 is short enough, and nothing else asks for more";
}

TEST(LazyRefinement, SplitsConstraintsForAnglesInTheMiddle) {
  ConstrainedMesh mesh = make({{0, 0}, {0.5, 0}, {0.5001, 0}, {1, 0}, {1, 1}, {0, 1}},
                              {{0, 1, 5}, {1, 2, 5}, {2, 4, 5}, {2, 3, 4}});
  refine_lazily(mesh, {0, 20.7, 1e-6, 100000});
  int on_left_half = 0;
  for (const Vec2& p : mesh.points) {
    if (p.y() != 0 || p.x() >= 0.5) continue;
    ++on_left_half;
    const double along = 0x1p20 * p.x();
    EXPECT_EQ(along, std::round(along));
  }
  EXPECT_GE(on_left_half, 5);
}

TEST(LazyRefinement, PartsOfAConstraintKeepItsId) {
  ConstrainedMesh mesh = make({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {{0, 2}});
  refine_lazily(mesh, {0.1, 20.7, 1e-4, 100000});
  std::map<int, double> length;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t.constraint[k] >= 0) {
        const Vec2 &a = mesh.point(t.corner[k]), &b = mesh.point(t.corner[(k + 1) % 3]);
        length[t.constraint[k]] += (b - a).norm() / (t.neighbour[k] < 0 ? 1 : 2);
        if (t.constraint[k] == 4) {
          EXPECT_NEAR(a.x(), a.y(), 1e-15);
        }
      }
  ASSERT_EQ(length.size(), 5U);
  for (int line = 0; line < 4; ++line) EXPECT_NEAR(length[line], 1, 1e-14);
  EXPECT_NEAR(length[4], std::sqrt(2), 1e-14);
  expect_delaunay_and_linked(mesh);
}

TEST(LazyRefinement, GradesFromSmallToLarge) {
  // A border edge of 1e-4 in a square of 1: with angles of 20.7° or more lengths can grow by a
  // factor of 2.8 a triangle, so that some tens of triangles lead from one to the other.
  ConstrainedMesh mesh = make({{0, 0}, {0.5, 0}, {0.5001, 0}, {1, 0}, {1, 1}, {0, 1}},
                              {{0, 1, 5}, {1, 2, 5}, {2, 4, 5}, {2, 3, 4}});
  EXPECT_TRUE(refine_lazily(mesh, {0, 20.7, 1e-6, 100000}));
  EXPECT_GE(angle_and_length(plain(mesh)).first, 20.699);
  EXPECT_LE(mesh.triangles.size(), 300U);
}

TEST(LazyRefinement, MakesNoEdgeShorterThanAsked) {
  for (const double shortest : {0.2, 0.02, 0.002}) {
    ConstrainedMesh mesh = make({{0, 0}, {0.5, 0}, {0.5001, 0}, {1, 0}, {1, 1}, {0, 1}},
                                {{0, 1, 5}, {1, 2, 5}, {2, 4, 5}, {2, 3, 4}});
    EXPECT_TRUE(refine_lazily(mesh, {0, 20.7, shortest, 100000}));
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t.corner[k], b = t.corner[(k + 1) % 3];
        if (std::max(a, b) >= 6) {
          EXPECT_GE((mesh.point(a) - mesh.point(b)).norm(), shortest);
        }
      }
  }
}

TEST(LazyRefinement, NarrowCornersEndAndStayAsTheyAre) {
  for (const double degrees : {30.0, 10.0, 1.0, 0.01}) {
    const double a = degrees * M_PI / 180;
    ConstrainedMesh mesh =
        make({{0, 0}, {1, 0}, {0.3 * std::cos(a), 0.3 * std::sin(a)}}, {{0, 1, 2}});
    EXPECT_TRUE(refine_lazily(mesh, {0, 20.7, 1e-7, 100000}));
    EXPECT_LE(mesh.triangles.size(), 50 + 100 / a) << degrees;
    int at_apex = 0;
    for (const auto& t : mesh.triangles)
      for (const int p : t.corner) at_apex += p == 0;
    EXPECT_EQ(at_apex, 1) << "a small input angle is not cut into smaller ones";
    expect_delaunay_and_linked(mesh);
  }
}

TEST(LazyRefinement, StopsAtTheTriangleLimit) {
  ConstrainedMesh mesh = square();
  EXPECT_FALSE(refine_lazily(mesh, {0.01, 20.7, 1e-5, 500}));
  EXPECT_GE(mesh.triangles.size(), 500U);
  EXPECT_LE(mesh.triangles.size(), 520U);
  expect_delaunay_and_linked(mesh);
}

TEST(LazyRefinement, StripsThinnerThanTheShortestEdgeAreCutToLengthOnly) {
  ConstrainedMesh mesh = make({{0, 0}, {1, 0}, {1, 1e-7}, {0, 1e-7}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_TRUE(refine_lazily(mesh, {0.3, 20.7, 1e-3, 100000}));
  EXPECT_LE(angle_and_length(plain(mesh)).second, 0.3);
  EXPECT_LE(mesh.triangles.size(), 20U);
}

TEST(PlanarSigns, AreExact) {
  // Three points on a line with slope 1 but for the last digit.
  const double e = 0x1p-52;
  EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
  EXPECT_EQ(orientation({0.5, 0.5 + e / 2}, {12, 12}, {24, 24}), 1);
  EXPECT_EQ(orientation({0.5, 0.5 - e / 2}, {12, 12}, {24, 24}), -1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {1, 1}, {0, 1}), 0);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {1, 1}, {0, 1 - e / 2}), 1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {1, 1}, {0, 1 + e}), -1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {1, 1}, {-e * e, 1}), -1);
}

}  // namespace
}  // namespace halfshade::test
