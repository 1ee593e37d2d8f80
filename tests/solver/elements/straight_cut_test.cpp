#include "solver/elements/straight_cut.h"

#include "solver/elements/linear_pieces.h"
#include "solver/elements/quadrature.h"
#include "solver/elements/straight_error.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// Elements of all orders and different sizes, with coefficients of all sizes.
struct CutSample {
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<double> areas;
  ElementField field;

  explicit CutSample(double size = 1) {
    test::Random random(51);
    std::vector<int> order;
    for (int e = 0; e < 2 * (max_order + 1); ++e) order.push_back(e % (max_order + 1));
    field = zero_field(order);
    for (int e = 0; e < field.count(); ++e) {
      triangles.push_back({random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)});
      const auto& t = triangles.back();
      areas.push_back((t[1] - t[0]).cross(t[2] - t[0]).norm() / 2);
      const double shrink = random(0.1, 0.9);
      for (int degree = 0; degree <= order[at(e)]; ++degree)
        for (int k = basis_size(degree - 1); k < basis_size(degree); ++k)
          for (int c = 0; c < 3; ++c)
            field.of(e)(k, c) = size * random(-1, 1) * std::pow(shrink, degree);
    }
  }
};

/// Mean square over each element of polynomial less straight pieces, by a rule on each of them.
std::vector<double> mean_squares(const CutSample& sample, std::span<const int> along_edge) {
  const LinearPieces pieces = linear_pieces(sample.triangles, sample.field, along_edge);
  const TriangleRule& rule = gauss_rule(2 * max_order);
  std::vector<double> square(sample.triangles.size(), 0.);
  for (std::size_t i = 0; i < pieces.corners.size(); ++i) {
    const int e = pieces.element[i];
    const auto point = [&](std::size_t k) { return pieces.points[at(pieces.corners[i][k])]; };
    const auto value = [&](std::size_t k) { return pieces.value[at(pieces.corners[i][k])]; };
    for (std::size_t k = 0; k < rule.places.size(); ++k) {
      const TrianglePlace& p = rule.places[k];
      const Rgb straight = value(0) + p.x() * (value(1) - value(0)) + p.y() * (value(2) - value(0));
      const Vec3 x = position({point(0), point(1), point(2)}, p);
      const Rgb curved = value_at(sample.field, e, place_of(sample.triangles[at(e)], x));
      square[at(e)] += rule.weights[static_cast<Eigen::Index>(k)] / pieces.pieces[at(e)] *
                       (curved - straight).matrix().squaredNorm();
    }
  }
  return square;
}

/// The error of a cut in the L2 norm, relative.
double error_of(const CutSample& sample, const StraightCut& cut) {
  const std::vector<double> off = mean_squares(sample, cut.along_edge);
  double error = 0, norm = 0;
  for (int e = 0; e < sample.field.count(); ++e) {
    error += sample.areas[at(e)] * off[at(e)];
    norm += sample.areas[at(e)] * sample.field.of(e).matrix().squaredNorm();
  }
  return std::sqrt(error / norm);
}

constexpr int many = 2'000'000;

TEST(StraightError, IsThatOfThePiecesHoweverManyThereAre) {
  const CutSample sample;
  StraightError error(sample.field, 1);
  for (const int n : {1, 2, 3, 7, 8, 9, 20}) {
    const std::vector<double> right =
        mean_squares(sample, std::vector<int>(sample.triangles.size(), n));
    for (int e = 0; e < sample.field.count(); ++e) {
      if (sample.field.order[at(e)] <= 1) {
        EXPECT_EQ(error.mean_square(e, n), 0);
      } else {
        EXPECT_NEAR(error.mean_square(e, n) / right[at(e)], 1, 1e-7) << e << ", " << n;
      }
    }
  }
}

TEST(StraightError, OfAParabolaIsInClosedForm) {
  // s² on the unit triangle, one piece: s² − s squared is s⁴ − 2 s³ + s² in the mean, and moments
  // of s are 2 / ((k + 1)(k + 2)).
  ElementField field = zero_field({2});
  const TriangleRule& rule = gauss_rule(8);
  const Eigen::MatrixXd basis = basis_at(2, rule.places);
  for (std::size_t i = 0; i < rule.places.size(); ++i)
    field.of(0).col(1) +=
        (rule.weights[static_cast<Eigen::Index>(i)] * std::pow(rule.places[i].x(), 2) *
         basis.row(static_cast<Eigen::Index>(i)).transpose())
            .array();
  const double whole = 2. / 30 - 2 * 2. / 20 + 2. / 12;
  StraightError error(field, 1);
  // All pieces bend alike.
  for (const int n : {1, 2, 5, 10, 100, 1000})
    EXPECT_NEAR(error.mean_square(0, n) * std::pow(n, 4), whole, 1e-12) << n;
}

TEST(StraightCut, KeepsWhatIsAllowedWithoutWaste) {
  // Squares of sizes beyond 1e154 are out of range.
  for (const double size : {1., 1e-170, 1e170}) {
    const CutSample sample(size);
    for (const double allowed : {0.3, 0.03, 3e-3, 3e-4}) {
      const StraightCut cut = straight_cut(sample.field, sample.areas, allowed, many);
      EXPECT_FALSE(cut.is_limited);
      EXPECT_LE(cut.relative_error, allowed);
      EXPECT_GE(cut.relative_error, 0.85 * allowed) << allowed;
      if (size == 1. && allowed > 0.01) {
        EXPECT_NEAR(error_of(sample, cut) / cut.relative_error, 1, 1e-6);
      }
    }
  }
}

TEST(StraightCut, SaysHowFarOffEachElementIs) {
  const CutSample sample;
  const StraightCut cut = straight_cut(sample.field, sample.areas, 0.02, many);
  const std::vector<double> right = mean_squares(sample, cut.along_edge);
  long long pieces = 0;
  for (int e = 0; e < sample.field.count(); ++e) {
    pieces += cut.along_edge[at(e)] * cut.along_edge[at(e)];
    EXPECT_NEAR(cut.off[e], std::sqrt(right[at(e)]), 1e-6 * cut.off[e] + 1e-13) << e;
  }
  EXPECT_EQ(cut.pieces(), pieces);
}

TEST(StraightCut, TakesFewerPiecesThanAllElementsAlike) {
  const CutSample sample;
  const StraightCut cut = straight_cut(sample.field, sample.areas, 0.02, many);
  StraightCut alike = cut;
  for (int n = 1; n < 1000; ++n) {
    alike.along_edge.assign(cut.along_edge.size(), n);
    if (alike.pieces() > cut.pieces()) break;
  }
  EXPECT_GT(error_of(sample, alike), 1.2 * cut.relative_error);
}

TEST(StraightCut, StopsAtTheMostPiecesAndSaysSo) {
  const CutSample sample;
  double last = 10;
  for (const int most : {30, 100, 1000}) {
    const StraightCut cut = straight_cut(sample.field, sample.areas, 1e-6, most);
    EXPECT_TRUE(cut.is_limited);
    EXPECT_LE(cut.pieces(), most);
    EXPECT_GT(cut.pieces(), 0.7 * most);
    EXPECT_LT(cut.relative_error, last);
    EXPECT_NEAR(error_of(sample, cut) / cut.relative_error, 1, 1e-6);
    last = cut.relative_error;
  }
  // Each element is a piece at least.
  const StraightCut cut = straight_cut(sample.field, sample.areas, 1e-6, 1);
  EXPECT_TRUE(cut.is_limited);
  EXPECT_EQ(cut.pieces(), sample.field.count());
}

TEST(StraightCut, OfWhatIsStraightOrDarkIsNone) {
  ElementField field = zero_field({0, 1, 2, 8});
  const std::vector<double> areas = {1, 2, 3, 4};
  const auto expect_whole = [&] {
    const StraightCut cut = straight_cut(field, areas, 0, many);
    EXPECT_EQ(cut.along_edge, std::vector<int>(4, 1));
    EXPECT_EQ(cut.relative_error, 0);
    EXPECT_FALSE(cut.is_limited);
    EXPECT_TRUE((cut.off == 0).all());
  };
  expect_whole();
  field.of(0).setOnes();
  field.of(1).setOnes();
  expect_whole();
  const StraightCut none = straight_cut(zero_field({}), {}, 0.1, many);
  EXPECT_TRUE(none.along_edge.empty());
}

}  // namespace
}  // namespace halfshade
