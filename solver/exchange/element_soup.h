#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/rays/occluders.h"

namespace halfshade {

/// The elements as triangles for rays, each its own owner, in the planes of their surfaces.
TriangleSoup element_soup(const SoundScene& scene, const ElementTable& elements);

}  // namespace halfshade
