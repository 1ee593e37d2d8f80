#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "solver/exchange/cells.h"
#include "solver/exchange/exchange.h"

namespace halfshade {

/// Finds the groups of elements that exchange light: a closed cell is one; in an open one they are
/// what the matrix connects. Enclosures that hold no lamp are common inside solids, as under the
/// leg of a table.
Enclosures find_enclosures(const SoundScene& scene, const ElementTable& elements,
                           const SpaceCells& cells, const ExchangeMatrix& matrix);

}  // namespace halfshade
