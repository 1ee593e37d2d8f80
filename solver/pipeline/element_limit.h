#pragma once

#include "solver/pipeline/solve_options.h"

#include <cstddef>

namespace halfshade {

/// The same options with a limit of elements: 40,000 where none is set, as the matrix' memory grows
/// with its square; with fields 40 for each polygon, if that is more, up to a million.
SolveOptions with_element_limit(SolveOptions options, std::size_t polygons);

}  // namespace halfshade
