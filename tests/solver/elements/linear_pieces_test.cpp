#include "solver/elements/linear_pieces.h"

#include "solver/elements/quadrature.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace halfshade {
namespace {

using Triangle = std::array<Vec3, 3>;

/// Elements of all orders, with coefficients that shrink from degree to degree as those of light.
struct Sample {
  std::vector<Triangle> triangles;
  ElementField field;

  explicit Sample(double shrink) {
    test::Random random(21);
    std::vector<int> order;
    for (int e = 0; e < 27; ++e) order.push_back(e % (max_order + 1));
    field = zero_field(order);
    for (int e = 0; e < field.count(); ++e) {
      triangles.push_back({random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)});
      for (int degree = 0; degree <= order[at(e)]; ++degree)
        for (int k = basis_size(degree - 1); k < basis_size(degree); ++k)
          for (int c = 0; c < 3; ++c) field.of(e)(k, c) = random(-1, 1) * std::pow(shrink, degree);
    }
  }
};

double area(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

Triangle corners_of(const LinearPieces& pieces, std::size_t piece) {
  const auto& c = pieces.corners[piece];
  return {pieces.points[at(c[0])], pieces.points[at(c[1])], pieces.points[at(c[2])]};
}

/// Root mean square over each element of polynomial less straight pieces, channels' squares summed.
std::vector<double> deviations(const Sample& sample, const LinearPieces& pieces) {
  const TriangleRule& rule = gauss_rule(6);
  std::vector<double> square(sample.triangles.size(), 0.);
  for (std::size_t i = 0; i < pieces.corners.size(); ++i) {
    const int e = pieces.element[i];
    const Triangle triangle = corners_of(pieces, i);
    const auto value = [&](std::size_t k) { return pieces.value[at(pieces.corners[i][k])]; };
    for (std::size_t k = 0; k < rule.places.size(); ++k) {
      const TrianglePlace& p = rule.places[k];
      const Rgb straight = (1 - p.x() - p.y()) * value(0) + p.x() * value(1) + p.y() * value(2);
      const Rgb curved =
          value_at(sample.field, e, place_of(sample.triangles[at(e)], position(triangle, p)));
      square[at(e)] += rule.weights[static_cast<Eigen::Index>(k)] / pieces.pieces[at(e)] *
                       (curved - straight).matrix().squaredNorm();
    }
  }
  for (double& s : square) s = std::sqrt(s);
  return square;
}

TEST(LinearPieces, CoverTheirElements) {
  const Sample sample(0.7);
  for (const double allowed : {1., 0.03, 1e-3, 1e-9}) {
    const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, allowed);
    ASSERT_EQ(pieces.element.size(), pieces.corners.size());
    ASSERT_EQ(pieces.pieces.size(), sample.triangles.size());
    ASSERT_EQ(pieces.value.size(), pieces.points.size());
    ASSERT_EQ(pieces.element_of_point.size(), pieces.points.size());
    std::vector<double> sum(sample.triangles.size(), 0.);
    std::vector<int> count(sample.triangles.size(), 0);
    for (std::size_t i = 0; i < pieces.corners.size(); ++i) {
      const int e = pieces.element[i];
      const Triangle piece = corners_of(pieces, i);
      const Triangle& whole = sample.triangles[at(e)];
      sum[at(e)] += area(piece);
      ++count[at(e)];
      // All alike, looking the same way, inside, with corners of its own element.
      EXPECT_NEAR(area(piece), area(whole) / pieces.pieces[at(e)], 1e-12);
      EXPECT_GT((piece[1] - piece[0])
                    .cross(piece[2] - piece[0])
                    .dot((whole[1] - whole[0]).cross(whole[2] - whole[0])),
                0);
      for (const int corner : pieces.corners[i]) {
        EXPECT_EQ(pieces.element_of_point[at(corner)], e);
        const TrianglePlace place = place_of(whole, pieces.points[at(corner)]);
        EXPECT_GE(std::min({place.x(), place.y(), 1 - place.x() - place.y()}), -1e-9);
      }
    }
    for (std::size_t e = 0; e < sum.size(); ++e) {
      EXPECT_NEAR(sum[e], area(sample.triangles[e]), 1e-12);
      EXPECT_EQ(count[e], pieces.pieces[e]);
      EXPECT_LE(count[e], 256);
    }
  }
}

TEST(LinearPieces, CornersHaveThePolynomialsValues) {
  const Sample sample(0.7);
  const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, 0.01);
  for (std::size_t i = 0; i < pieces.points.size(); ++i) {
    const int e = pieces.element_of_point[i];
    const Rgb expected =
        value_at(sample.field, e, place_of(sample.triangles[at(e)], pieces.points[i]));
    EXPECT_LT((pieces.value[i] - expected).abs().maxCoeff(), 1e-9) << e;
  }
}

TEST(LinearPieces, StayCloseOrAreAsManyAsMayBe) {
  // The faster coefficients shrink, the closer: the estimate is that of a slight bend.
  for (const auto& [shrink, times] : {std::pair(0.1, 4.), {0.3, 7.}}) {
    const Sample sample(shrink);
    for (const double allowed : {0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4}) {
      const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, allowed);
      const std::vector<double> off = deviations(sample, pieces);
      for (std::size_t e = 0; e < off.size(); ++e)
        if (pieces.pieces[e] < 256) {
          EXPECT_LE(off[e], times * allowed) << sample.field.order[e] << ", " << shrink;
        }
    }
  }
}

TEST(LinearPieces, WhatIsStraightIsNotCut) {
  const Sample sample(1);
  const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, 1e-12);
  for (std::size_t e = 0; e < sample.triangles.size(); ++e)
    EXPECT_EQ(pieces.pieces[e], sample.field.order[e] <= 1 ? 1 : 256) << e;
  const std::vector<double> off = deviations(sample, pieces);
  for (std::size_t e = 0; e < off.size(); ++e)
    if (sample.field.order[e] <= 1) {
      EXPECT_LT(off[e], 1e-10);
    }
  const LinearPieces coarse =
      linear_pieces(sample.triangles, sample.field, std::numeric_limits<double>::infinity());
  EXPECT_EQ(coarse.corners.size(), sample.triangles.size());
}

TEST(LinearPieces, DarkWithoutAnythingAllowedIsNotCut) {
  const Sample sample(0);
  const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, 0);
  for (const int count : pieces.pieces) EXPECT_EQ(count, 1);
}

TEST(LinearPieces, TheLessIsAllowedTheMoreThereAre) {
  const Sample sample(0.5);
  std::size_t last = 0;
  for (const double allowed : {1., 0.1, 0.01, 1e-3, 1e-4}) {
    const std::size_t count = linear_pieces(sample.triangles, sample.field, allowed).corners.size();
    EXPECT_GE(count, last);
    last = count;
  }
  EXPECT_GT(last, 10 * sample.triangles.size());
}

}  // namespace
}  // namespace halfshade
