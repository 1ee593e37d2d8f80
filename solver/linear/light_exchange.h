#pragma once

#include "solver/exchange/exchange.h"

#include <Eigen/Core>

#include <functional>

namespace halfshade {

/// An exchange of light as solvers see it, whatever computes it. Symmetric: power that goes from i
/// to j per unit of radiosity goes from j to i, too.
struct LightExchange {
  /// out(i) = Σ_j A_i F(i,j) in(j) for elements i with wanted(i) ≠ 0; the others become 0. What it
  /// refers to must outlive it.
  std::function<void(const Eigen::VectorXd& in, const Eigen::VectorXd& wanted,
                     Eigen::VectorXd& out)>
      apply;
  Eigen::ArrayXd area;  ///< A_i
  /// A_i times the share of what leaves i that meets nothing; exactly 0 in a closed system.
  Eigen::ArrayXd lost;
  Enclosures systems;                      ///< which elements exchange light with each other
  const ExchangeMatrix* matrix = nullptr;  ///< A F, if there is one

  /// A·F·in for all elements.
  Eigen::VectorXd apply_all(const Eigen::VectorXd& in) const;
};

/// The matrix as one; it must outlive the result.
LightExchange light_exchange(const Exchange& exchange);

}  // namespace halfshade
