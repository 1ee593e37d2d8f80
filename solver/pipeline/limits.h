#pragma once

#include "solver/pipeline/solve_options.h"

#include <cstddef>

namespace halfshade {

/// The same options with limits where none are set: 40,000 elements, as the memory of the matrix
/// grows with their square; with fields 400 for each polygon, if that is more, up to a million,
/// or 16 for each, up to ten millions. And four unknowns for each of these elements, or a million,
/// if that is more.
SolveOptions with_limits(SolveOptions options, std::size_t polygons);

}  // namespace halfshade
