#pragma once

#include "solver/linear/light_exchange.h"
#include "solver/linear/radiosity.h"

#include <vector>

namespace halfshade {

/// One channel of one system: elements that exchange light with each other and with no others.
struct LightSystem {
  const LightExchange& exchange;
  std::vector<int> elements;
  int id = 0;  ///< among exchange.systems
};

/// What its elements are made of and receive; entries of other elements do not matter.
struct SystemLight {
  const Eigen::VectorXd& rho;
  const Eigen::VectorXd& exitance;
  const Eigen::VectorXd& direct_irradiance;
};

struct SystemReport {
  int unknowns = 0;
  int iterations = 0;
  std::vector<double> history;  ///< residual after each, relative to the direct light
  double residual = 0;          ///< relative to the direct light
  /// Bound of the relative error of the reflected radiosity that the residual makes: the residual
  /// times the inverse of the smallest eigenvalue.
  double error = 0;
};

/// Solves for the reflected radiosity R = B − E of a system, and puts it into the entries of its
/// elements: (A/ρ − A F) R = A H_d. Written with the power that each element loses, by absorption,
/// through openings and to black elements, it is (losses + L) R = A H_d, L the Laplacian of the
/// exchange, whose rows and columns sum to zero. Summed over all elements, L is gone: what is lost
/// is what was put in. That is one equation for the mean of R weighted with the losses, the mode
/// that is slow and ill-conditioned where little is lost; it is solved by itself, and what is left
/// has no part in it. So a closed room with ρ = 1 − 1e-12 is as exact as one with ρ = 0.5. The rest
/// is solved by conjugate gradients, scaled by the diagonal. Light is scaled by a power of two
/// first, so that no size of it over- or underflows.
/// Where nothing is lost there is a solution only if nothing is put in; of all, it is the one whose
/// radiosity is smallest. Throws Error(invalid_input) otherwise; see unlimited_systems.
SystemReport solve_system(const LightSystem& system, const SystemLight& light,
                          const RadiosityOptions& options, Eigen::VectorXd& reflected);

}  // namespace halfshade
