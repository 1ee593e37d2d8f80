#pragma once

#include "solver/exchange/patch_factors.h"
#include "solver/linear/radiosity.h"

#include <vector>

namespace halfshade {

/// Patches send light, the elements that they are divided into receive it (Cohen, Greenberg, Immel
/// and Brock 1986).
struct TwoLevels {
  const std::vector<double>& area;   ///< of each element
  const std::vector<int>& patch_of;  ///< likewise
  const PatchFactors& factors;       ///< from elements to patches
};

/// H = H_d + F R on the elements, R the reflected radiosity of the patches: the mean of ρH over the
/// elements of each. `rho`, `exitance` and `direct_irradiance` have one row an element; the last
/// has none if it is F E. Elements of a patch have one ρ and E. With `bounces` the Neumann series
/// is summed instead. Of the report it sets iterations, history, residual and error of the
/// channels, and converged. The error bounds that of the reflected radiosity, relative, both in the
/// maximum norm. The solution's error estimate is left empty.
Solution solve_two_levels(const TwoLevels& levels, const ChannelArray& rho,
                          const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                          const RadiosityOptions& options, RadiosityReport& report);

}  // namespace halfshade
