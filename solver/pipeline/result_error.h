#pragma once

#include "solver/pipeline/solve.h"

#include <string>

namespace halfshade {

/// What solution.error_estimate, of the elements, and the solver's residual come to, relative to
/// the L2 norm of the irradiance. For constant elements.
double error_of_elements_and_solver(const SolveResult& result);

/// "0.012 of the irradiance instead of 0.01", with as many digits as tell the two apart.
std::string error_instead(double error, const std::string& of_what, double tolerance);

}  // namespace halfshade
