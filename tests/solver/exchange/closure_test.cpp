#include "solver/exchange/exchange.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace halfshade {
namespace {

/// A random symmetric non-negative matrix with the given share of zeros, and areas near its row
/// sums.
struct Random {
  ExchangeMatrix matrix;
  Eigen::ArrayXd area;

  Random(int n, double error, double zeros, unsigned seed) : matrix(n, n), area(n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j)
        if (u(random) >= zeros) full(i, j) = full(j, i) = u(random);
    for (int i = 0; i < n; ++i) area[i] = full.row(i).sum() * (1 + error * (2 * u(random) - 1));
    matrix = full.sparseView();
  }
};

std::vector<bool> all(std::size_t n) { return std::vector<bool>(n, true); }

double closure_error(const ExchangeMatrix& matrix, const Eigen::ArrayXd& area) {
  const Eigen::ArrayXd sums = (matrix * Eigen::VectorXd::Ones(area.size())).array();
  return (sums / area - 1).abs().maxCoeff();
}

TEST(EnforceClosure, RowsSumToTheirAreasAndSymmetrySignAndZerosStay) {
  for (const double error : {1e-6, 1e-2, 0.3})
    for (unsigned seed = 0; seed < 5; ++seed) {
      Random r(60, error, 0.5, seed);
      const ExchangeMatrix before = r.matrix;
      ASSERT_GT(closure_error(r.matrix, r.area), error / 10);
      ASSERT_TRUE(enforce_closure(r.matrix, r.area, all(60)));
      EXPECT_LE(closure_error(r.matrix, r.area), 1e-12);
      EXPECT_EQ(r.matrix.nonZeros(), before.nonZeros());
      EXPECT_TRUE((Eigen::MatrixXd(r.matrix).array() >= 0).all());
      EXPECT_EQ((Eigen::MatrixXd(r.matrix) - Eigen::MatrixXd(r.matrix).transpose()).norm(), 0);
    }
}

TEST(EnforceClosure, RowsNotWantedMayStayOpen) {
  // Two groups that do not exchange; only the first is to be closed.
  Random a(30, 0.05, 0.3, 8), b(20, 0.05, 0.3, 9);
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(50, 50);
  full.topLeftCorner(30, 30) = Eigen::MatrixXd(a.matrix);
  full.bottomRightCorner(20, 20) = Eigen::MatrixXd(b.matrix);
  ExchangeMatrix matrix = full.sparseView();
  Eigen::ArrayXd area(50);
  area << a.area, b.area;
  std::vector<bool> wanted(50, false);
  std::fill_n(wanted.begin(), 30, true);
  ASSERT_TRUE(enforce_closure(matrix, area, wanted));
  const Eigen::ArrayXd sums = (matrix * Eigen::VectorXd::Ones(50)).array();
  EXPECT_LE((sums.head(30) / a.area - 1).abs().maxCoeff(), 1e-12);
  EXPECT_EQ((Eigen::MatrixXd(matrix) - full).bottomRightCorner(20, 20).norm(), 0);
}

TEST(EnforceClosure, AClosedMatrixStaysAsItIs) {
  Random r(40, 0, 0.2, 3);
  const ExchangeMatrix before = r.matrix;
  ASSERT_TRUE(enforce_closure(r.matrix, r.area, all(40)));
  EXPECT_LE((Eigen::MatrixXd(r.matrix) - Eigen::MatrixXd(before)).norm(),
            1e-12 * Eigen::MatrixXd(before).norm());
}

TEST(EnforceClosure, ElementsThatSeeNothingAreLeftOut) {
  Random r(30, 0.01, 0.3, 4);
  Eigen::MatrixXd full(31, 31);
  full.setZero();
  full.topLeftCorner(30, 30) = Eigen::MatrixXd(r.matrix);
  ExchangeMatrix matrix = full.sparseView();
  Eigen::ArrayXd area(31);
  area << r.area, 1.;
  ASSERT_TRUE(enforce_closure(matrix, area, all(31)));
  const Eigen::ArrayXd sums = (matrix * Eigen::VectorXd::Ones(31)).array();
  EXPECT_LE((sums.head(30) / r.area - 1).abs().maxCoeff(), 1e-12);
  EXPECT_EQ(sums[30], 0);
}

TEST(EnforceClosure, AnImpossibleDemandLeavesTheMatrixAlone) {
  // Two elements that see only each other exchange the same area, whatever the scaling.
  Eigen::MatrixXd full(2, 2);
  full << 0, 1, 1, 0;
  ExchangeMatrix matrix = full.sparseView();
  EXPECT_FALSE(enforce_closure(matrix, Eigen::ArrayXd::LinSpaced(2, 1, 2), all(2)));
  EXPECT_EQ((Eigen::MatrixXd(matrix) - full).norm(), 0);
}

}  // namespace
}  // namespace halfshade
