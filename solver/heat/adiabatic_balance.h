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
/// y = Σ_k ε_k e_k(T) = Σ_k ε_k H_k, H linear in what the faces send out. By Newton's method for y:
/// as a function of y each band's part is nearly straight, however steep it is in T, and T follows
/// from y face by face. 0 where nothing arrives,
/// or less than can be followed; NaN for faces that are black in no band at all, and where no
/// temperature is found. Precondition: as blackbody_exitance. To rounding.
Eigen::ArrayXd balanced_temperatures(const AdiabaticBalance& balance,
                                     const std::vector<Band>& bands);

}  // namespace halfshade
