#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/events/emitter_scene.h"

#include <span>
#include <vector>

namespace halfshade {

/// A scene with one of its sources; all must outlive what is made of it.
struct LitFromOne {
  const SoundScene& scene;
  const OpaqueScene& opaque;
  const EmitterScene& emitter_scene;
  double exitance;                 ///< W/m²
  std::span<const int> receivers;  ///< to look at
};

/// The curves of one source as its swaths make them: some lie on others, and none has its jumps
/// yet. Kinds that would take more than `most_work` are left out; HUGE_VAL: none. Adds to the
/// report what was done. Deterministic for any number of threads.
std::vector<DiscontinuityCurve> search_curves(const LitFromOne& lit,
                                              const DiscontinuityOptions& options, double most_work,
                                              const Progress& progress,
                                              DiscontinuityReport& report);

/// What that would take, told from some of the edges, vertices and surfaces.
SearchForecast forecast_curves(const LitFromOne& lit, const DiscontinuityOptions& options,
                               const Progress& progress);

}  // namespace halfshade
