#pragma once

#include "solver/reflected/reflected_cost.h"
#include "solver/reflected/reflected_state.h"

namespace halfshade {

/// Points at which direct light is asked for in a round, where rows are exact parts.
inline constexpr int points_of_exact_projection = 100000;

/// A tolerance that a single round meets, with fewer rays than others.
inline constexpr double any_error = 1;

/// The rounds of solving, estimating and refining, until the tolerance is met or a limit stops it.
/// What is found is kept after each. False if it was given up.
bool run_rounds(ReflectedLight::State& state, const ReflectedOptions& options,
                const GiveUp& give_up, const Progress& progress);

}  // namespace halfshade
