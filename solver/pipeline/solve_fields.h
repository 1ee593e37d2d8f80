#pragma once

#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"

namespace halfshade {

/// Solves for light as polynomials: direct light on elements made for it. Adds to a result that
/// begin_result has begun.
void solve_fields(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                  const Progress& progress, Stages& stages, SolveResult& result);

}  // namespace halfshade
