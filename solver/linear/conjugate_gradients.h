#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace halfshade {

using LinearMap = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct IterationLimits {
  double residual = 0;  ///< stop once ‖b − A x‖ is no larger
  int iterations = 1000;
};

struct IterationResult {
  Eigen::VectorXd x;
  int iterations = 0;
  std::vector<double> residuals;  ///< ‖b − A x‖ after each, as the iteration has it
  /// The smallest eigenvalue of A that the iteration has seen (its smallest Ritz value); 1 if there
  /// was none.
  double smallest_eigenvalue = 1;
};

/// Solves A x = b from x = 0 by conjugate gradients (Hestenes and Stiefel 1952). `A` must be
/// symmetric and positive semi-definite, b in its range. Not preconditioned: scale A first.
IterationResult conjugate_gradients(const LinearMap& A, const Eigen::VectorXd& b,
                                    const IterationLimits& limits);

}  // namespace halfshade
