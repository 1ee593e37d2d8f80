#pragma once

#include "meshing/backprojection/visible_part.h"

#include <Eigen/Core>

#include <vector>

namespace halfshade {

using ChannelArray =
    Eigen::Array<double, Eigen::Dynamic, 3>;  ///< one row an element, one column a channel

/// The light on each element, in W/m².
struct Solution {
  ChannelArray rho;                ///< reflectance
  ChannelArray exitance;           ///< E
  ChannelArray radiosity;          ///< B = E + rho·H
  ChannelArray irradiance;         ///< H
  ChannelArray direct_irradiance;  ///< the part of H that comes straight from emitters
  std::vector<Region> region;      ///< with respect to the strongest emitter; empty if not known
  Eigen::ArrayXd error_estimate;   ///< of the irradiance, see recovery_estimate
  /// Of more bands than there are channels, one column each. All of the above are then sums over
  /// them in each channel, and rho the share that is reflected of all that arrives.
  Eigen::ArrayXXd band_radiosity, band_irradiance;
};

}  // namespace halfshade
