#pragma once

#include "solver/direct/direct_light.h"
#include "solver/pipeline/prepared_scene.h"

#include <vector>

namespace halfshade {

/// Places that light of emitters falls on, the fewer the darker they are: where up to `count` rays
/// end that leave the emitters as their light does. Fewer where rays end nowhere, or behind a
/// surface. The same whatever the unit of length.
std::vector<SurfacePoint> lit_places(const PreparedScene& prepared, int count);

}  // namespace halfshade
