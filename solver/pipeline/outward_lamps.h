#pragma once

#include "meshing/core/sound_scene.h"

#include <string>
#include <vector>

namespace halfshade {

/// Groups whose light goes nowhere: no surface lies before their emitters and looks back. A wall of
/// a room that emits, turned the wrong way, leaves no other trace where there are more lamps. Not
/// looked for where most surfaces emit, as they do by their warmth, and send it out of the scene,
/// nor where it may take more than some seconds, among very many such emitters.
std::vector<std::string> outward_lamps(const SoundScene& scene);

}  // namespace halfshade
