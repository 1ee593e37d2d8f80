#pragma once

#include "meshing/core/types.h"
#include "solver/reflected/reflected_light.h"

namespace halfshade {

/// The square that errors of G are relative to: `square_total`, of all irradiance, or what a goal
/// says. Light is in units of which `scale` make one W/m².
double norm_square(const ReflectedOptions& options, const Rgb& scale, double square_total);

/// The square of what G may be off, where errors are relative to the square `all`.
double allowed_square(const ReflectedOptions& options, const Rgb& scale, double all);

}  // namespace halfshade
