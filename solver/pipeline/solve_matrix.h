#pragma once

#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"

namespace halfshade {

/// Solves for light by constant elements and a matrix of their form factors. Adds to a result that
/// begin_result has begun.
void solve_matrix(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                  const Progress& progress, Stages& stages, SolveResult& result);

}  // namespace halfshade
