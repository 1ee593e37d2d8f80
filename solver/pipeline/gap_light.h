#pragma once

#include "solver/elements/material_arrays.h"
#include "solver/exchange/exchange.h"

namespace halfshade {

/// Light that elements reflect which lie nearer to others than they are long, as a multiple of the
/// power put in: the largest of the channels. Constant elements do not show how much of it gets
/// out. In spaces that no light leaves that does not matter; they do not count. One row an element.
/// Cost: that of a matrix–vector product.
double light_in_gaps(const Exchange& exchange, const MaterialArrays& materials,
                     const ChannelArray& irradiance);

}  // namespace halfshade
