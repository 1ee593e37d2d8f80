#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// Where light falls in spots that samples might overlook: rings around the point of a surface that
/// is next to a source (surface id), if the surface is far larger than what is lit most.
std::vector<WatchedPlace> spot_places(const SoundScene& scene, std::span<const int> sources);

}  // namespace halfshade
