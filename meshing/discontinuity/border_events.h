#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/events/emitter_scene.h"

#include <vector>

namespace halfshade {

/// Where a receiver crosses the emitter's plane and sees the emitter edge-on: before it the
/// irradiance grows from zero. Appends straight curves of order 1.
void emitter_plane_curves(const SoundScene& scene, const OpaqueScene& opaque,
                          const EmitterScene& emitter_scene, int receiver,
                          std::vector<DiscontinuityCurve>& curves);

/// The contact lines of a receiver at which the irradiance from the emitter jumps. Appends straight
/// curves of order 0.
void contact_curves(const SoundScene& scene, const OpaqueScene& opaque,
                    const EmitterScene& emitter_scene, int receiver,
                    std::vector<DiscontinuityCurve>& curves);

}  // namespace halfshade
