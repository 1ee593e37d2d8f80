#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/adapt/fitted_element.h"

#include <span>
#include <vector>

namespace halfshade {

/// The elements that matter most, the worst first; the square error of the others is `may_stay`.
std::vector<int> worst_elements(std::span<const FittedElement> elements, double may_stay);

/// The order that an element should have; its own if it should be split. `target` is the square
/// error that it may have.
int better_order(const FittedElement& element, const AdaptiveFieldOptions& options, double target);

/// Top degrees go while the square error is at most `most`, those first that matter least for an
/// unknown.
void drop_orders(std::span<FittedElement> elements, double most);

}  // namespace halfshade
