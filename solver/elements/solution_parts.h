#pragma once

#include "solver/elements/solution.h"

#include <vector>

namespace halfshade {

/// What parts of elements have: of each part that of the element named, which must be one of
/// `whole`. Regions only if `whole` has them.
Solution solution_of_parts(const Solution& whole, const std::vector<int>& element);

}  // namespace halfshade
