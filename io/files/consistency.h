#pragma once

#include "solver/pipeline/solve.h"

namespace halfshade::detail {

/// Throws Error(contract) unless every array of the result has as many entries as there are
/// elements and every corner is a point.
void require_consistent(const SolveResult& result, const char* caller);
void require_consistent(const ElementTable& elements, const char* caller);

}  // namespace halfshade::detail
