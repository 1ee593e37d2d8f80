#pragma once

#include "solver/heat/heat.h"

#include <vector>

namespace halfshade {

/// Of bands (rows): what a body of this temperature sends out, ε e(T), W/m², and how it changes.
struct Emission {
  Eigen::ArrayXd power;
  Eigen::ArrayXd growth;  ///< T times the derivative by T
};

/// Preconditions: as blackbody_exitance; the temperature is > 0.
Emission emission_at(double temperature, const Eigen::ArrayXd& emissivity,
                     const std::vector<Band>& bands);

/// The temperature in K at which a body sends out this much in all bands together, W/m². 0 for what
/// is too little to be followed, see blackbody_exitance; NaN where no temperature from 1e-60 K to
/// 1e60 K does. To rounding. `start` is where to begin, if anything is known; 0: nothing.
double emission_temperature(double power, const Eigen::ArrayXd& emissivity,
                            const std::vector<Band>& bands, double start = 0);

}  // namespace halfshade
