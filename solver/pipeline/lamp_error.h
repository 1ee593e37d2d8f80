#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/pipeline/solve.h"

/// What irradiance is off because lamps shine evenly instead of as their pictures do.
namespace halfshade {

/// Of the tolerance of direct light that is to be found: what is left beside such lamps.
double share_beside_lamps(const SolveOptions& options);

/// Relative to light on elements, in the L2 norm; 0 in the dark.
double relative_lamp_error(const SolveOptions& options, const ElementField& light,
                           const ElementTable& elements);

/// Adds what `options` know of them to the error of direct light, whose elements share it as they
/// share theirs.
void add_lamp_error(const SolveOptions& options, AdaptiveField& direct);

/// Adds it to the error of all light, for light that is not found as above.
void add_lamp_error(const SolveOptions& options, SolveResult& result);

}  // namespace halfshade
