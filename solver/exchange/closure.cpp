#include "solver/exchange/exchange.h"
#include "solver/exchange/scaled_operator.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr int max_newton_steps = 50;
/// Row sums this close to their areas are as good as rounding lets them be.
constexpr double closed_enough = 1e-13;
/// Once rounding keeps the error from falling, up to this many times that is closed, too.
constexpr double patience = 10;
/// Of a Newton step; Newton's own convergence makes up for the rest.
constexpr double step_tolerance = 1e-6;
constexpr int max_step_iterations = 500;
/// Beyond this the scaling would no longer be a correction.
constexpr double largest_step = 1;

void scale_both_sides(ExchangeMatrix& matrix, const Eigen::VectorXd& s) {
  for (Eigen::Index i = 0; i < matrix.outerSize(); ++i)
    for (ExchangeMatrix::InnerIterator entry(matrix, i); entry; ++entry)
      // The product of the two factors first, so that (i,j) and (j,i) stay equal to the bit.
      entry.valueRef() *= s[entry.row()] * s[entry.col()];
}

}  // namespace

bool enforce_closure(ExchangeMatrix& matrix, const Eigen::ArrayXd& area,
                     const std::vector<bool>& wanted) {
  // Unknowns: u = log s. Residual of row i: s_i (M s)_i − A_i. Its Jacobian diag(s∘Ms) + S M S is
  // symmetric and positive semi-definite, for M is not negative.
  const Eigen::Index n = matrix.rows();
  const Eigen::VectorXd sees = multiply(matrix, Eigen::VectorXd::Ones(n));
  Eigen::ArrayXd free(n);  // 1 where u may change
  for (Eigen::Index i = 0; i < n; ++i)
    free[i] = wanted[static_cast<std::size_t>(i)] && sees[i] > 0 ? 1 : 0;
  Eigen::VectorXd s = Eigen::VectorXd::Ones(n);
  double previous_error = HUGE_VAL;
  for (int step = 0; step < max_newton_steps; ++step) {
    const Eigen::VectorXd sums = s.cwiseProduct(multiply(matrix, s));
    const Eigen::VectorXd residual = free * (sums.array() - area);
    const double error = (residual.array() / area).abs().maxCoeff();
    if (error <= closed_enough || (error <= patience * closed_enough && error >= previous_error)) {
      scale_both_sides(matrix, s);
      return true;
    }
    if (!std::isfinite(error)) return false;
    previous_error = error;
    // Fixed rows get weight 0; their root is anything but 0.
    const Eigen::VectorXd root = sums.array().sqrt() + (1 - free);
    const ScaledOperator jacobian(matrix, free * s.array() / root.array(), 1);
    ConjugateGradients cg(jacobian);
    cg.setTolerance(step_tolerance);
    cg.setMaxIterations(max_step_iterations);
    Eigen::VectorXd du = -cg.solve(residual.cwiseQuotient(root)).cwiseQuotient(root);
    const double size = du.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return false;
    if (size > largest_step) du *= largest_step / size;
    s.array() *= du.array().exp();
  }
  return false;
}

}  // namespace halfshade
