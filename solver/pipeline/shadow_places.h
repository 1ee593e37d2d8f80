#pragma once

#include "meshing/core/light_source.h"
#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// Where shadows fall that samples might overlook: the middles of `blocking`, the surfaces that can
/// come between others, seen from the middle of each source, on what lies next behind them; the
/// area is that of the shadow of a source that is a point. Of very many only the largest are
/// followed.
std::vector<WatchedPlace> shadow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking);

}  // namespace halfshade
