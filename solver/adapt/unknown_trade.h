#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/adapt/fitted_element.h"

#include <span>
#include <utility>
#include <vector>

namespace halfshade {

/// What elements should get before orders are dropped until the square error is `most`, so that far
/// fewer unknowns are left than without: elements, and their orders, or their own if they should be
/// split. As the layers of the elements tell, and what more orders or a split are likely to do.
/// Empty if it is not worth it.
std::vector<std::pair<int, int>> better_spread(std::span<const FittedElement> elements,
                                               const AdaptiveFieldOptions& options, double most);

/// Top degrees go while the square error is at most `most`, those first that matter least for an
/// unknown.
void drop_orders(std::span<FittedElement> elements, const AdaptiveFieldOptions& options,
                 double most);

}  // namespace halfshade
