#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// Places around the corners of emitters (surface ids) that touch a surface or nearly do, nearer
/// and nearer. There light depends on the direction from the corner however close one comes, which
/// the few samples of an element that holds the corner do not tell. Cost: corners times surfaces.
std::vector<WatchedPlace> corner_places(const SoundScene& scene, std::span<const int> sources);

}  // namespace halfshade
