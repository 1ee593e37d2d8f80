#include "solver/linear/conjugate_gradients.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// Of the tridiagonal matrix that conjugate gradients are a factorisation of (Lanczos 1950).
double smallest_ritz_value(const std::vector<double>& steps, const std::vector<double>& turns) {
  const auto n = static_cast<Eigen::Index>(steps.size());
  if (n == 0) return 1;
  Eigen::VectorXd diagonal(n), beside(n - 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    diagonal[k] = 1 / steps[i] + (k > 0 ? turns[i - 1] / steps[i - 1] : 0);
    if (k + 1 < n) beside[k] = std::sqrt(turns[i]) / steps[i];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0];
}

}  // namespace

IterationResult conjugate_gradients(const LinearMap& A, const Eigen::VectorXd& b,
                                    const IterationLimits& limits) {
  IterationResult result;
  result.x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd residual = b, direction = b;
  double norm2 = residual.squaredNorm();
  std::vector<double> steps, turns;
  while (result.iterations < limits.iterations && std::sqrt(norm2) > limits.residual) {
    const Eigen::VectorXd image = A(direction);
    const double energy = direction.dot(image);
    if (!(energy > 0)) break;  // rounding is all that is left
    const double step = norm2 / energy;
    result.x += step * direction;
    residual -= step * image;
    const double last = norm2;
    norm2 = residual.squaredNorm();
    direction = residual + norm2 / last * direction;
    steps.push_back(step);
    turns.push_back(norm2 / last);
    result.residuals.push_back(std::sqrt(norm2));
    ++result.iterations;
  }
  result.smallest_eigenvalue = smallest_ritz_value(steps, turns);
  return result;
}

}  // namespace halfshade
