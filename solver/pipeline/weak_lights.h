#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"

#include <string>
#include <vector>

namespace halfshade {

/// Groups whose emitters are so much weaker than the strongest of the scene, and not in stronger
/// light, that squares of what is reflected of theirs are zero beside it in double precision: the
/// solver of reflected light, which has one scale for all of a scene, then finds nothing of it.
std::vector<std::string> weak_lights(const SoundScene& scene, const ElementTable& elements,
                                     const Solution& solution);

}  // namespace halfshade
