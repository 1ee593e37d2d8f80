#pragma once

#include "solver/reflected/exact_gather.h"
#include "solver/reflected/reflection_estimate.h"

#include <vector>

namespace halfshade {

/// Compares irradiance with what arrives of leaving light at random places, by exactly visible
/// parts. `gather` is of the light that leaves where that irradiance arrives.
ReflectionEstimate estimate_exactly(const ExactSight& sight, const ExactGather& gather,
                                    const ReflectedSystem& system,
                                    const SplitIrradiance& irradiance,
                                    std::vector<ProbePlace> probes, const Progress& progress);

}  // namespace halfshade
