#pragma once

#include "solver/heat/heat.h"

#include <vector>

namespace halfshade {

/// Faces that exchange light in several bands, and what of it they get from others.
struct AdiabaticBalance {
  Eigen::ArrayXXd emissivity;  ///< of each face (row) in each band (column), in [0, 1]
  /// Irradiance of each in each band while they send out ε times `rest`, W/m².
  Eigen::ArrayXXd arriving;
  Eigen::ArrayXd rest;  ///< in each band, W/m²
  /// Of each band: irradiance of the row's face for each W/m² that the column's face sends out.
  std::vector<Eigen::MatrixXd> response;
};

/// Temperatures in K at which each face absorbs as much as it sends out, over all bands together:
/// Σ_k ε_k (H_k − e_k(T)) = 0, H linear in what the faces send out. By Newton's method: e_k grows
/// ever faster with T, so that from above it only falls. NaN for faces that are black in no band at
/// all, 0 where nothing arrives. Precondition: as blackbody_exitance. To rounding.
Eigen::ArrayXd balanced_temperatures(const AdiabaticBalance& balance,
                                     const std::vector<Band>& bands);

}  // namespace halfshade
