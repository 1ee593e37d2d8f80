#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>

namespace halfshade {

/// Corners and edges, of emitters and of what can hide them (surface ids), that touch other
/// surfaces or nearly do. Contacts themselves are lines that elements follow; narrow gaps are not,
/// and light that comes through one changes within its width.
Watched near_features(const SoundScene& scene, std::span<const int> sources,
                      std::span<const int> blockers);

}  // namespace halfshade
