#pragma once

#include "solver/direct/direct_light.h"

#include <string_view>
#include <vector>

namespace halfshade {

/// Points on the front of all surfaces of the group called `name`, on a square grid of `spacing`
/// scene units in each surface's frame, centred in its bounding box; those outside the polygon are
/// left out. Throws Error(usage) if there is no such group or nothing of it is left,
/// Error(contract) unless the spacing is positive and finite, Error(too_large) for more than 1e8
/// points.
std::vector<SurfacePoint> surface_grid(const SoundScene& scene, std::string_view name,
                                       double spacing);

}  // namespace halfshade
