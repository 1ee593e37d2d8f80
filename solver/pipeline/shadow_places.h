#pragma once

#include "meshing/core/light_source.h"
#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// Where shadows and penumbrae fall that samples might overlook: places on `blocking`, the surfaces
/// that can come between others, seen from the middle of each source and from its corners, on what
/// lies next behind them; the areas are those of the shadows of points, shared out among what is
/// seen of a blocker from a source. Where there are very many, only the middles are followed, and
/// only those of the largest blockers.
std::vector<WatchedPlace> shadow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking);

}  // namespace halfshade
