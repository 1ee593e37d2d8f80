#pragma once

#include "solver/factors/factor_scene.h"
#include "solver/factors/sight_scene.h"

#include <cstddef>

namespace halfshade {

/// About how many CPU seconds the exact exchange of a scene takes at a tolerance of a percent, as
/// some thousand of its pairs tell; at finer ones it takes more.
double exact_seconds(const FactorScene& scene, const SightScene& sight);

/// About how many rays so many CPU seconds are.
std::size_t rays_in(double seconds);

}  // namespace halfshade
