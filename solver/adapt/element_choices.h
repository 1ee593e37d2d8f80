#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/adapt/fitted_element.h"

#include <span>
#include <vector>

namespace halfshade {

/// The elements that matter most, the worst first; the square error of the others is `may_stay`.
std::vector<int> worst_elements(std::span<const FittedElement> elements, double may_stay);

/// Coefficients that shrink faster from degree to degree are worth more of them: with this decay,
/// one more order and four smaller elements gain alike per unknown.
inline constexpr double smooth = 0.45;

/// New elements for one that is split, with what it takes to stay conforming.
inline constexpr double elements_for_one = 2.5;

/// Whether an element should be split, if it may be, and not have a higher order.
bool is_to_split(const FittedElement& element, const AdaptiveFieldOptions& options);

/// The order that an element should have; its own if it should be split. `target` is the square
/// error that it may have.
int better_order(const FittedElement& element, const AdaptiveFieldOptions& options, double target);

}  // namespace halfshade
