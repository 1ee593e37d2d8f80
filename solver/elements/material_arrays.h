#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"

namespace halfshade {

/// What the elements are made of, one row an element.
struct MaterialArrays {
  ChannelArray rho;
  ChannelArray exitance;  ///< W/m²
};

MaterialArrays material_arrays(const SoundScene& scene, const ElementTable& elements);

}  // namespace halfshade
