#pragma once

#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "solver/reflected/reflected_light.h"

namespace halfshade {

struct GoalWeights;

/// Solves for light as polynomials: direct light on elements made for it. Adds to a result that
/// begin_result has begun.
void solve_fields(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                  const Progress& progress, Stages& stages, SolveResult& result);

/// How reflected light is found, to a tolerance of all light; `goal` is null where all light
/// counts.
ReflectedOptions reflected_options(const SoundScene& scene, const Plan& plan,
                                   const SolveOptions& options, double tolerance,
                                   const GoalWeights* goal);

}  // namespace halfshade
