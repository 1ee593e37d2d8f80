#pragma once

#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

#include <string>

namespace halfshade {

/// The light on the elements of a mesh, and how it was found.
struct SolvedLight {
  Solution solution;  ///< without an error estimate
  ExchangeReport exchange;
  RadiosityReport radiosity;
};

/// Finds direct light, form factors and radiosity on given elements. `no_exact_direct_light` says
/// why direct light comes out of the matrix; empty: it is exact. Of the options it reads
/// `direct_points`, `exchange` and `radiosity`. Adds its stages to `stages`. If stopped, factors
/// not reached count as zero.
SolvedLight solve_light(const PreparedScene& prepared, const ElementTable& elements,
                        const std::string& no_exact_direct_light, const SolveOptions& options,
                        const Progress& progress, Stages& stages);

}  // namespace halfshade
