#pragma once

#include "solver/reflected/irradiance_row.h"
#include "solver/reflected/reflection_estimate.h"

namespace halfshade {

/// What rows are made with for an estimate.
struct ExactProbes {
  const ExactSight& sight;
  const ReflectingScene& scene;
  RowAccuracy accuracy;
  int direct_points = 20000;  ///< see DirectProjection
};

/// Compares irradiance with what arrives of leaving light at random points, by exactly visible
/// parts. There the direct light is taken from elements cut in four: what the polynomials of the
/// leaving light are off shows as well. Of the probes, `rays` is not used.
ReflectionEstimate estimate_exactly(const ExactProbes& exact, const ReflectedSystem& system,
                                    const SplitIrradiance& irradiance,
                                    const ReflectionProbes& probes, const Progress& progress);

}  // namespace halfshade
