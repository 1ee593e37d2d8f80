#pragma once

#include "solver/pipeline/solve.h"

namespace halfshade {

/// What solution.error_estimate, of the elements, and the solver's residual come to, relative to
/// the L2 norm of the irradiance. For constant elements.
double error_of_elements_and_solver(const SolveResult& result);

}  // namespace halfshade
