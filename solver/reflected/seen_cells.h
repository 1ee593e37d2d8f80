#pragma once

#include "solver/reflected/reflecting_scene.h"

namespace halfshade {

/// Makes one of cells that light gets between. Which there are is told from edges that meet end to
/// end: where the few digits of a file leave splinters, one space may come out as several, and
/// their surfaces would exchange nothing. Rays from the middle of each root tell: cells are one if
/// more than a hundredth of what leaves one of them gets to the other, which cracks do not let
/// through. It is closed if both were. Cost: up to 2^18 rays; none where fronts look into one cell.
void join_seen_cells(ReflectingScene& scene);

}  // namespace halfshade
