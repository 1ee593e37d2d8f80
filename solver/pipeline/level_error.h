#pragma once

#include "solver/elements/material_arrays.h"
#include "solver/exchange/exchange.h"

namespace halfshade {

/// How far the light of an enclosure is off in all because its elements are constant and some of it
/// gets lost, to openings or to backs of surfaces: a matrix takes what an element loses from its
/// mean, and in truth its bright parts may lose less than its dark ones. That is at most the
/// product of what both vary by, as recovery_estimate has it; summed over the elements of an
/// enclosure and relative to the power put in there, it is what all light there is off by. In W/m²,
/// the root mean square over the channels, one entry an element; 0 in closed enclosures.
Eigen::ArrayXd level_error(const ElementTable& elements, const Exchange& exchange,
                           const MaterialArrays& materials, const ChannelArray& irradiance);

}  // namespace halfshade
