#pragma once

#include "solver/adapt/fitted_element.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// A place of an element that is close to a corner or an edge that is watched.
struct NearLook {
  int element;
  int group;  ///< of places that stand for the same error: those of a corner, or of all edges
  TrianglePlace place;
  double share;  ///< of the element's area
};

/// Where to look at elements that are not checked, nearer and nearer to what is watched: on circles
/// around corners, on parallels to edges. Elements that matter most come first, until there are
/// `most` places: `mean_square` is the field's.
std::vector<NearLook> near_looks(std::span<const FittedElement> elements, const Watched& watched,
                                 double mean_square, std::size_t most);

/// Puts up the errors of elements where values say so, one a look.
void take_near_looks(std::span<const NearLook> looks, std::span<const Rgb> values,
                     std::span<FittedElement> elements);

}  // namespace halfshade
