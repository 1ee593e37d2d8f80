#include "solver/elements/joined_field.h"

#include "meshing/core/error.h"
#include "tests/support/random.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

using Triangle = std::array<Vec3, 3>;

const Vec3 o(0, 0, 0), east(1, 0, 0), north(0, 1, 0), west(-1, 0, 0), south(0, -1, 0);
/// Around the origin; the edge from corner 0 to 1 leaves it, that from 2 to 0 arrives.
const std::vector<Triangle> four = {
    {o, east, north}, {o, north, west}, {o, west, south}, {o, south, east}};

/// The border of the four is closed, and so are some of the edges from the origin: leaving,
/// arriving.
std::vector<std::array<int, 3>> orders_of_four(const std::array<bool, 4>& closed) {
  std::vector<std::array<int, 3>> orders;
  for (std::size_t e = 0; e < 4; ++e)
    orders.push_back({closed[e] ? 0 : -1, 0, closed[(e + 1) % 4] ? 0 : -1});
  return orders;
}

ElementTable table_of(const std::vector<Triangle>& triangles,
                      std::vector<std::array<int, 3>> edge_order) {
  return connected(triangles, std::vector<int>(triangles.size(), 0), std::move(edge_order));
}

ElementField random_field(std::vector<int> order) {
  test::Random random(7);
  ElementField field = zero_field(std::move(order));
  for (double& c : field.coefficients.reshaped()) c = random(-1, 1);
  return field;
}

Rgb value_in_space(const ElementField& field, const Triangle& triangle, int element,
                   const Vec3& point) {
  return value_at(field, element, place_of(triangle, point));
}

void expect_kept_at_origin(const ElementField& before, const ElementField& field,
                           std::initializer_list<int> elements) {
  for (const int e : elements)
    EXPECT_LT((value_in_space(field, four[at(e)], e, o) - value_in_space(before, four[at(e)], e, o))
                  .abs()
                  .maxCoeff(),
              1e-12);
}

/// The largest step from element to element along the line between two points.
double step(const ElementField& field, const std::vector<Triangle>& triangles, int first,
            int second, const Vec3& from, const Vec3& to) {
  double largest = 0;
  for (int k = 0; k <= 20; ++k) {
    const Vec3 p = from + k / 20. * (to - from);
    largest = std::max(largest, (value_in_space(field, triangles[at(first)], first, p) -
                                 value_in_space(field, triangles[at(second)], second, p))
                                    .abs()
                                    .maxCoeff());
  }
  return largest;
}

TEST(JoinedField, IsContinuousWhateverTheOrders) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  for (const std::vector<int>& order :
       {std::vector{0, 0, 0, 0}, {0, 1, 2, 3}, {8, 1, 4, 0}, {2, 2, 2, 2}, {5, 8, 3, 7}}) {
    ElementField field = random_field(order);
    const ElementField before = field;
    join(elements, Eigen::Array4d(1, 0.5, 2, 0.1), field);
    for (int e = 0; e < 4; ++e) {
      const int next = (e + 1) % 4;
      const Vec3& end = four[at(e)][2];
      EXPECT_GT(step(before, four, e, next, o, end), 0.1);
      EXPECT_LT(step(field, four, e, next, o, end), 1e-11);
      EXPECT_EQ(field.order[at(e)],
                std::max({1, order[at(e)], order[at((e + 3) % 4)], order[at(next)]}));
    }
  }
}

TEST(JoinedField, WhatIsContinuousStaysAsItIs) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  // A cubic in space, on elements of different orders that hold it.
  ElementField field = zero_field({3, 5, 4, 8});
  for (int e = 0; e < 4; ++e) {
    const auto nodes = element_nodes(field.order[at(e)]);
    Eigen::MatrixXd values(nodes.size(), 3);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Vec3 p = position(four[at(e)], nodes[k]);
      values.row(static_cast<Eigen::Index>(k)) << p.x() * p.y() * p.y() - 2 * p.x(), 1, p.y();
    }
    field.of(e) = element_node_basis(field.order[at(e)]).partialPivLu().solve(values).array();
  }
  const ElementField before = field;
  join(elements, Eigen::Array4d::Constant(1e-6), field);
  EXPECT_EQ(field.order, before.order);
  EXPECT_TRUE((field.coefficients == before.coefficients).all());
}

TEST(JoinedField, TheBetterElementSaysMore) {
  const std::vector<Triangle> two = {{o, east, north}, {west, o, north}};
  const ElementTable elements = table_of(two, {{0, 0, -1}, {0, -1, 0}});
  ASSERT_EQ(elements.neighbours[0], (std::array{-1, -1, 1}));
  ASSERT_EQ(elements.neighbours[1], (std::array{-1, 0, -1}));
  ElementField field = zero_field({0, 0});
  field.of(0) = 2;
  field.of(1) = 7;
  join(elements, Eigen::Array2d(1, 2), field);  // four to one
  for (const Vec3& p : {o, Vec3(0, 0.3, 0), north})
    EXPECT_NEAR(value_in_space(field, two[0], 0, p)[1], 3, 1e-12);
  EXPECT_NEAR(value_in_space(field, two[0], 0, east)[1], 2, 1e-12);
  EXPECT_NEAR(value_in_space(field, two[1], 1, west)[1], 7, 1e-12);
}

TEST(JoinedField, WhereNoErrorIsKnownAllSayTheSame) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  ElementField field = zero_field({0, 0, 0, 0});
  for (int e = 0; e < 4; ++e) field.of(e) = 1 + e;
  join(elements, Eigen::Array4d::Constant(HUGE_VAL), field);
  EXPECT_NEAR(value_in_space(field, four[0], 0, o)[2], 2.5, 1e-12);
  EXPECT_NEAR(value_in_space(field, four[0], 0, north)[2], 1.5, 1e-12);
}

TEST(JoinedField, TrianglesThatAreNoMeshHaveNoNeighbours) {
  const std::vector<Triangle> heap = {
      {o, east, north}, {o, east, north}, {o, west, o}, {o, north, west}};
  for (const auto& neighbours :
       connected(heap, std::vector<int>(4, 0), {4, {-1, -1, -1}}).neighbours)
    EXPECT_EQ(neighbours, (std::array{-1, -1, -1}));
}

TEST(JoinedField, AnExactElementKeepsItsLight) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  ElementField field = random_field({0, 3, 2, 1});
  field.of(0) = 0;  // in the umbra
  join(elements, Eigen::Array4d(0, 0.3, 0.4, 0.5), field);
  EXPECT_EQ(field.order[0], 0);
  EXPECT_TRUE((field.of(0) == 0).all());
  EXPECT_LT(step(field, four, 0, 1, o, north), 1e-12);
  EXPECT_LT(step(field, four, 3, 0, o, east), 1e-12);
}

TEST(JoinedField, StripsTooNarrowToBeSeenFollowTheirNeighbours) {
  // Two strips along a lit facet, in the dark, one of them only at its corner, as exact as darkness
  // is.
  const Vec3 below(1, -1e-5, 0), corner(0, -1e-5, 0);
  const std::vector<Triangle> three = {{o, east, north}, {east, o, below}, {corner, below, o}};
  const ElementTable elements = table_of(three, {{-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}});
  ElementField field = zero_field({0, 0, 0});
  field.of(0) = 3;
  join(elements, Eigen::Array3d(0.1, 0, 0), field);
  for (const Vec3& p : {o, Vec3(0.3, 0, 0), east, north})
    EXPECT_NEAR(value_in_space(field, three[0], 0, p)[1], 3, 1e-12);
  EXPECT_NEAR(value_in_space(field, three[1], 1, east)[1], 3, 1e-9);
  EXPECT_NEAR(value_in_space(field, three[2], 2, o)[1], 3, 1e-9);
}

TEST(JoinedField, NothingBleedsAcrossLinesWhereLightJumps) {
  // From east over the origin to west.
  const ElementTable elements = table_of(four, orders_of_four({true, false, true, false}));
  EXPECT_EQ(elements.points.size(), 8U);  // three are there twice
  ElementField field = random_field({1, 2, 3, 2});
  field.of(2).setZero();
  field.of(3).setZero();
  join(elements, Eigen::Array4d::Ones(), field);
  EXPECT_TRUE((field.of(2) == 0).all());
  EXPECT_TRUE((field.of(3) == 0).all());
  EXPECT_LT(step(field, four, 0, 1, o, north), 1e-12);
}

TEST(JoinedField, WhereALineEndsLightHasManyValues) {
  const ElementTable elements = table_of(four, orders_of_four({true, false, false, false}));
  EXPECT_EQ(elements.points.size(), 6U);  // east is there twice
  ElementField field = random_field({2, 2, 2, 2});
  const ElementField before = field;
  join(elements, Eigen::Array4d::Ones(), field);
  expect_kept_at_origin(before, field, {0, 1, 2, 3});
  EXPECT_LT(step(field, four, 0, 1, 0.999 * north, north),
            0.01 * step(before, four, 0, 1, o, north));
}

TEST(JoinedField, AtACornerOfWhatStandsThereLightHasManyValues) {
  // Something stands on the first: the other three go round its corner.
  const ElementTable elements = table_of(four, orders_of_four({true, true, false, false}));
  ElementField field = random_field({2, 2, 2, 2});
  const ElementField before = field;
  join(elements, Eigen::Array4d::Ones(), field);
  expect_kept_at_origin(before, field, {1, 2, 3});
  EXPECT_LT(step(field, four, 1, 2, 0.999 * west, west), 0.01 * step(before, four, 1, 2, o, west));
}

TEST(JoinedField, TwoSidesOfASheetAreNotNeighbours) {
  std::vector<Triangle> sides = {{o, east, north}, {west, o, north}};
  for (const Triangle& t : {sides[0], sides[1]}) sides.push_back({t[0], t[2], t[1]});
  const ElementTable elements =
      connected(sides, std::vector{0, 0, 1, 1}, std::vector<std::array<int, 3>>(4, {-1, -1, -1}));
  EXPECT_EQ(elements.neighbours[0], (std::array{-1, -1, 1}));
  EXPECT_EQ(elements.neighbours[1], (std::array{-1, 0, -1}));
  EXPECT_EQ(elements.neighbours[2], (std::array{3, -1, -1}));
  EXPECT_EQ(elements.neighbours[3], (std::array{-1, 2, -1}));
  EXPECT_EQ(elements.points.size(), 8U);
}

TEST(JoinedField, LightOfAnySizeIsJoined) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  for (const double factor : {1e-150, 1e150}) {
    ElementField field = random_field({2, 1, 0, 3});
    field.coefficients *= factor;
    join(elements, factor * Eigen::Array4d(1, 2, 0, 1), field);
    EXPECT_TRUE(field.coefficients.allFinite());
    EXPECT_LT(step(field, four, 0, 1, o, north), 1e-11 * factor);
  }
}

TEST(JoinedField, CountsMustBeTheSame) {
  const ElementTable elements = table_of(four, orders_of_four({}));
  ElementField field = zero_field({0, 0, 0});
  EXPECT_THROW(join(elements, Eigen::Array4d::Ones(), field), Error);
  field = zero_field({0, 0, 0, 0});
  EXPECT_THROW(join(elements, Eigen::Array3d::Ones(), field), Error);
}

}  // namespace
}  // namespace halfshade
