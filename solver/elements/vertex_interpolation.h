#pragma once

#include "solver/elements/element_field.h"

namespace halfshade {

/// Constant elements as pictures of radiosity show them: linear between values at points, which are
/// the means of the elements around, weighted with their areas, and at borders what a plane through
/// the elements there, and their neighbours, comes to; never below zero where no element is.
/// Points are split across curves of order 0 and between surfaces, so nothing bleeds over them. One
/// row a point.
ChannelArray interpolated_at_points(const ElementTable& elements,
                                    const ChannelArray& element_values);

/// The linear functions through them, of order 1 on all elements.
ElementField interpolated_field(const ElementTable& elements, const ChannelArray& element_values);

}  // namespace halfshade
