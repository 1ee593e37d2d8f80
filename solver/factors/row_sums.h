#pragma once

#include "solver/factors/surface_exchange.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace halfshade {

/// What rows sum to beside one, and what their entries together claim to be off by at most, as
/// mutual areas.
struct RowSums {
  /// Of a sum of a row.
  static constexpr double rounding = 1e-13;

  Eigen::ArrayXd area, missing, claimed;

  RowSums(const FactorScene& scene, const RowExchange& exchange)
      : area(Eigen::Map<const Eigen::ArrayXd>(scene.areas.data(), scene.rows())),
        missing((exchange.mutual.rowwise().sum().array() + exchange.space - area).abs() +
                rounding * area),
        claimed(exchange.mutual_error.rowwise().sum().array() + exchange.space_error) {}

  /// An entry is off by more than it claims: sums tell, rounding aside.
  bool is_refuted(Eigen::Index row) const {
    return missing[row] > claimed[row] + 2 * rounding * area[row];
  }
  /// The most that an entry can be off by, so far as the others are what they claim to be.
  double bound(Eigen::Index row, double error) const {
    return missing[row] > claimed[row] ? HUGE_VAL
                                       : missing[row] + std::max(0., claimed[row] - error);
  }
};

}  // namespace halfshade
