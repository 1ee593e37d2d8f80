#pragma once

#include "solver/adapt/adaptive_field.h"

#include <cstddef>

namespace halfshade {

/// The order that elements begin with: low ones where they will do; what is too high is dropped in
/// the end.
int first_order(const AdaptiveFieldOptions& options);

/// How many orders fewer elements begin with that have a small share of the mean area: most matter
/// little, and in clutter there are many.
int modesty(double share);

/// The places at which elements are checked: evenly spread over the triangle, different for each
/// index (Roberts' sequence).
TrianglePlace spread_place(std::size_t index);

}  // namespace halfshade
