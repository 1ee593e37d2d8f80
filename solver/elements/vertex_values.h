#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"

namespace halfshade {

/// Values at the points of a mesh: the area-weighted mean of the values of the elements around each
/// point. One row a point. Points are already split across D0 curves, so nothing bleeds over them.
ChannelArray values_at_points(const ElementTable& elements, const ChannelArray& element_values);

}  // namespace halfshade
