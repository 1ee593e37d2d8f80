#pragma once

#include "solver/pipeline/solve.h"

#include <algorithm>

namespace halfshade::test {

inline bool has_warning(const SolveResult& result, Warning::Kind kind) {
  return std::any_of(result.warnings.begin(), result.warnings.end(),
                     [&](const Warning& warning) { return warning.kind == kind; });
}

}  // namespace halfshade::test
