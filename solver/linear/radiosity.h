#pragma once

#include "meshing/core/progress.h"
#include "solver/elements/solution.h"
#include "solver/linear/light_exchange.h"
#include "solver/linear/radiosity_stages.h"

#include <array>
#include <optional>
#include <vector>

namespace halfshade {

/// What solves the equations of a matrix; see sweep for all but the first.
enum class RadiositySolver {
  conjugate_gradients,
  jacobi,
  gauss_seidel,
  southwell,
  southwell_ambient
};

struct RadiosityOptions {
  RadiositySolver solver = RadiositySolver::conjugate_gradients;
  double tolerance = 1e-10;  ///< relative residual at which the iteration stops, in (0, 1)
  int max_iterations = 1000;
  int max_sweeps = 100000;    ///< the same of the other solvers
  bool all_channels = false;  ///< also where all three are the same
  bool stages = false;        ///< keep those of shooting; needs a solver that shoots
  int bounces = -1;  ///< −1: all; n ≥ 0: light that arrives after at most n reflections
};

struct ChannelReport {
  int iterations = 0;           ///< of the system that took most; or sweeps
  std::vector<double> history;  ///< relative residual after each of them
  double residual = 0;  ///< ‖b − S y‖ / ‖b‖ of the system solved; of several, the largest
  double error = 0;     ///< relative error of the reflected radiosity that residuals make, at most
  double emitted_power = 0;   ///< Σ A E, in W (for lengths in metres)
  double absorbed_power = 0;  ///< Σ A (1 − rho) H
  double escaped_power = 0;   ///< what leaves through openings, of direct and of reflected light
  double balance = 0;         ///< |emitted − absorbed − escaped| / emitted
};

struct RadiosityReport {
  int channels = 0;  ///< 1 if the scene is grey, else 3
  int unknowns = 0;  ///< elements that reflect, in the channel with most of them
  int systems = 0;   ///< parts that exchange no light with each other and have some, solved apart
  std::array<ChannelReport, 3> channel;  ///< grey: all three the same
  bool converged = true;
  std::vector<RadiosityStage> stages;  ///< if asked for, of all bounces
};

/// Whether a solver shoots, so that it has stages to show.
constexpr bool shoots(RadiositySolver solver) {
  return solver == RadiositySolver::southwell || solver == RadiositySolver::southwell_ambient;
}

/// A closed system whose radiosity has no limit, for nothing in it absorbs.
struct UnlimitedSystem {
  int system = 0;
  double power = 0;  ///< that is put in, W
};

/// Finds the first in any channel.
std::optional<UnlimitedSystem> find_unlimited(const LightExchange& exchange,
                                              const ChannelArray& rho,
                                              const ChannelArray& exitance);

/// Solves B = E + rho·(H_d + F (B − E)) for each channel and each system by itself; see
/// solve_system. Elements with rho = 0 are eliminated. With `bounces` it sums the Neumann series
/// instead; other solvers than conjugate gradients know no systems, and need a matrix. `rho` and
/// `exitance` have one row an element; `direct_irradiance` too, or none if it is F E. The error
/// estimate is left empty. Throws Error(invalid_input) where a closed system of perfect reflectors
/// (rho = 1) would gain energy without end, and where the radiosity is beyond what doubles hold.
Solution solve_radiosity(const LightExchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress = {});

/// The same with a matrix.
Solution solve_radiosity(const Exchange& exchange, const ChannelArray& rho,
                         const ChannelArray& exitance, const ChannelArray& direct_irradiance,
                         const RadiosityOptions& options, RadiosityReport& report,
                         const Progress& progress = {});

}  // namespace halfshade
