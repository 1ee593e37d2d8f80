#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"

namespace halfshade {

/// What surfaces and contacts alone take, whatever the shape of elements: enough to tell which
/// parts of space they lie in. Cost: a constrained triangulation.
ElementTable fewest_elements(const SoundScene& scene, const Progress& progress = {});

}  // namespace halfshade
