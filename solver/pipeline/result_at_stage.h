#pragma once

#include "solver/pipeline/solve.h"

namespace halfshade {

/// The result as it was at a stage of progressive refinement. Its error estimate is that of the
/// result and what the irradiance had still to change. Precondition: the elements are constant.
SolveResult result_at_stage(SolveResult result, const RadiosityStage& stage);

}  // namespace halfshade
