#pragma once

#include "meshing/core/progress.h"
#include "solver/elements/solution.h"
#include "solver/exchange/exchange.h"

#include <array>

namespace halfshade {

struct RadiosityOptions {
  double tolerance = 1e-10;  ///< relative residual at which the iteration stops, in (0, 1)
  int max_iterations = 1000;
  int bounces = -1;  ///< −1: all; n ≥ 0: only light reflected at most n times
};

struct ChannelReport {
  int iterations = 0;
  double residual = 0;        ///< ‖b − S y‖ / ‖b‖ of the system solved
  double emitted_power = 0;   ///< Σ A E, in W (for lengths in metres)
  double absorbed_power = 0;  ///< Σ A (1 − rho) H
  double escaped_power = 0;   ///< what leaves through openings, of direct and of reflected light
  double balance = 0;         ///< |emitted − absorbed − escaped| / emitted
};

struct RadiosityReport {
  int channels = 0;  ///< 1 if the scene is grey, else 3
  int unknowns = 0;  ///< elements that reflect, in the channel with most of them
  std::array<ChannelReport, 3> channel;  ///< grey: all three the same
  bool converged = true;
};

/// Solves B = E + rho·(H_d + F (B − E)) for each channel by conjugate gradients on the symmetric
/// positive definite form, preconditioned by its diagonal; elements with rho = 0 are eliminated.
/// With `bounces` it sums the Neumann series instead. `rho` and `exitance` have one row an element.
/// The error estimate is left empty.
/// Throws Error(invalid_input) where a closed enclosure of perfect reflectors (rho = 1) would gain
/// energy without end.
Solution solve_radiosity(const Exchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress = {});

}  // namespace halfshade
