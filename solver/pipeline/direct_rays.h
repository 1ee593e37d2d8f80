#pragma once

#include "meshing/core/progress.h"
#include "solver/direct/ray_light.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

namespace halfshade {

/// How direct light is looked at by rays, where that takes much less than exact looks and the
/// tolerance allows it: large scenes full of things, to some percent. Without a deviation: not at
/// all. From the light at a hundred places; the same for any number of threads. Throws
/// Error(too_large) where none of them is lit and exact looks would take hours.
RayLightOptions direct_rays(const PreparedScene& prepared, const SolveOptions& options,
                            const Progress& progress = {});

}  // namespace halfshade
