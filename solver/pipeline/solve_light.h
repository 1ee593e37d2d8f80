#pragma once

#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

namespace halfshade {

/// The light on the elements of a mesh, and how it was found.
struct SolvedLight {
  Solution solution;  ///< without an error estimate
  ExchangeReport exchange;
  RadiosityReport radiosity;
  /// What the irradiance is off by for estimated factors and for light that gets lost, see
  /// estimation_error and level_error. W/m².
  Eigen::ArrayXd exchange_error;
  double in_gaps = 0;  ///< see light_in_gaps
};

/// Finds direct light, form factors and radiosity on given elements, as far as the plan does not
/// leave them out. Of the options it reads `direct_points`, `exchange` and `radiosity`. Adds its
/// stages to `stages`. If stopped, see compute_exchange.
SolvedLight solve_light(const PreparedScene& prepared, const ElementTable& elements,
                        const Plan& plan, const SolveOptions& options, const Progress& progress,
                        Stages& stages);

}  // namespace halfshade
