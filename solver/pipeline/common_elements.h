#pragma once

#include "solver/pipeline/solve.h"

#include <vector>

namespace halfshade {

/// Puts the light of several results, of one scene with different light in it, on the same
/// elements: those of the result that has most, split where the light of the others takes it (if
/// results have their patches), with the highest order that any has there. Error estimates grow by
/// what that loses, which is a small share of them. Nothing changes where elements are the same
/// already, as those of faces are. Fills elements, direct, irradiance, and of the solutions
/// irradiance, direct_irradiance, region and error_estimate; the rest of a solution is dropped.
/// Throws Error(invalid_input) if the results' surfaces differ.
void share_elements(std::vector<SolveResult>& results);

}  // namespace halfshade
