#include "solver/reflected/lockstep_gmres.h"

#include "tests/support/random.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

TEST(LockstepGmres, SolvesSystemsOfAllSizesOfLight) {
  constexpr int n = 60, half = 20;
  test::Random random(1);
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  RowGroups groups{{}, Eigen::ArrayXd(n), 2};
  for (int i = 0; i < n; ++i) {
    groups.of_row.push_back(i < half ? 0 : 1);
    groups.weight[i] = random(0.1, 3);
    for (int j = 0; j < n; ++j)
      if ((i < half) == (j < half)) A(i, j) -= random(0, 1.9) / (i < half ? half : n - half);
  }
  ChannelArray b(n, 3);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c)
      b(i, c) = random(0, 1) * std::pow(10., c == 2 ? -190 : c) * (i < half ? 1 : 1e160);
  b.col(1).tail(n - half).setZero();
  const auto apply = [&](const ChannelArray& x) { return ChannelArray((A * x.matrix()).array()); };
  const GmresResult result = gmres(apply, b, groups, 1e-12, 200);
  const Eigen::MatrixXd expected = A.lu().solve(b.matrix());
  EXPECT_LE(result.residual, 1e-12);
  for (int g = 0; g < 2; ++g)
    for (int c = 0; c < 3; ++c) {
      const auto off = (result.x.matrix() - expected).col(c);
      const auto whole = expected.col(c);
      const auto norm = [&](const auto& v) {
        return g == 0 ? v.head(half).template lpNorm<Eigen::Infinity>()
                      : v.tail(n - half).template lpNorm<Eigen::Infinity>();
      };
      EXPECT_LE(norm(off), 1e-9 * norm(whole)) << g << ' ' << c;
    }
}

TEST(LockstepGmres, LeavesSystemsAloneThatAreSolved) {
  // Hundreds of systems of two, solved in two steps, beside one that takes many.
  constexpr int pairs = 300, large = 80, n = 2 * pairs + large;
  test::Random random(2);
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  RowGroups groups{{}, Eigen::ArrayXd::Ones(n), pairs + 1};
  double smallest = 1;  // singular value
  for (int k = 0; k < pairs; ++k) {
    groups.of_row.insert(groups.of_row.end(), 2, k);
    A(2 * k, 2 * k + 1) = -random(0, 0.9);
    A(2 * k + 1, 2 * k) = -random(0, 0.9);
    const Eigen::JacobiSVD<Eigen::Matrix2d> values(A.block<2, 2>(2 * k, 2 * k));
    smallest = std::min(smallest, values.singularValues()[1]);
  }
  groups.of_row.insert(groups.of_row.end(), large, pairs);
  for (int i = 2 * pairs; i < n; ++i)
    for (int j = 2 * pairs; j < n; ++j) A(i, j) -= random(0, 1.6) / large;
  const Eigen::JacobiSVD<Eigen::MatrixXd> values(A.bottomRightCorner(large, large));
  smallest = std::min(smallest, values.singularValues()[large - 1]);
  ChannelArray b(n, 3);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) b(i, c) = random(0, 1);
  const auto apply = [&](const ChannelArray& x) { return ChannelArray((A * x.matrix()).array()); };
  const GmresResult result = gmres(apply, b, groups, 1e-9, 200);
  EXPECT_GT(result.iterations, 4);
  EXPECT_LE(result.residual, 1e-9);
  EXPECT_LE((A * result.x.matrix() - b.matrix()).norm(), 1e-9 * b.matrix().norm());
  EXPECT_LE(result.amplification, 1.001 / smallest);
}

TEST(LockstepGmres, KnowsTheAmplificationWhereStepsEndInRounding) {
  // Nearly all comes back, most of it evenly, so that few directions are left after some steps.
  constexpr int n = 80;
  constexpr double lost = 1e-7, less_each = 0.1;
  test::Random random(3);
  Eigen::MatrixXd any(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) any(i, j) = random(-1, 1);
  const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ();
  Eigen::VectorXd comes_back(n);
  for (int k = 0; k < n; ++k) comes_back[k] = (1 - lost) * std::pow(less_each, k);
  const Eigen::MatrixXd A =
      Eigen::MatrixXd::Identity(n, n) - Q * comes_back.asDiagonal() * Q.transpose();
  const auto apply = [&](const ChannelArray& x) { return ChannelArray((A * x.matrix()).array()); };
  ChannelArray b(n, 3);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) b(i, c) = random(0, 1);
  RowGroups groups{std::vector<int>(n, 0), Eigen::ArrayXd::Ones(n), 1};
  for (const double tolerance : {1e-9, 1e-10, 1e-11}) {
    const GmresResult result = gmres(apply, b, groups, tolerance, 600);
    // To what rounding of A is of its smallest singular value.
    EXPECT_NEAR(result.amplification * lost, 1, 1e-8) << tolerance;
    const Eigen::MatrixXd expected = A.lu().solve(b.matrix());
    EXPECT_LE((result.x.matrix() - expected).norm(), 1e-8 * expected.norm()) << tolerance;
  }
}

TEST(LockstepGmres, GivesNothingForNothing) {
  RowGroups groups{{0, 0}, Eigen::ArrayXd::Ones(2), 1};
  const GmresResult result =
      gmres([](const ChannelArray& x) { return x; }, ChannelArray::Zero(2, 3), groups, 1e-9, 10);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE((result.x == 0).all());
}

TEST(LockstepGmres, EndsAfterTheStepInWhichItIsStopped) {
  constexpr int n = 50;
  RowGroups groups{std::vector<int>(n, 0), Eigen::ArrayXd::Ones(n), 1};
  const auto apply = [](const ChannelArray& x) {
    return ChannelArray(x.colwise() * Eigen::ArrayXd::LinSpaced(n, 1, 1000));
  };
  int asked = 0;
  const GmresResult result =
      gmres(apply, ChannelArray::Ones(n, 3), groups, 1e-12, 500, [&asked] { return ++asked >= 4; });
  EXPECT_EQ(result.iterations, 4);
  EXPECT_GT(result.residual, 1e-12);
  EXPECT_TRUE(result.x.isFinite().all());
  EXPECT_GT(result.x.abs().maxCoeff(), 0);
}

TEST(LockstepGmres, DoesNotSolveForWhatIsNoNumber) {
  ChannelArray b = ChannelArray::Ones(4, 3);
  b(2, 1) = std::nan("");
  const GmresResult result = gmres([](const ChannelArray& x) { return x; }, b,
                                   {{0, 0, 0, 0}, Eigen::ArrayXd::Ones(4), 1}, 1e-6, 50);
  EXPECT_EQ(result.residual, HUGE_VAL);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE((result.x == 0).all());
}

}  // namespace
}  // namespace halfshade
