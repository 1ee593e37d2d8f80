#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/rays/visibility.h"
#include "solver/exchange/exchange.h"

namespace halfshade {

/// Finds the groups of elements that are connected by exchange of light, and whether each is
/// closed: whether all rays from its elements, 64 from each, meet the front of a surface.
/// Enclosures that hold no lamp are common inside solids, as under the leg of a table.
Enclosures find_enclosures(const SoundScene& scene, const ElementTable& elements,
                           const VisibilityIndex& visibility, const ExchangeMatrix& matrix);

}  // namespace halfshade
