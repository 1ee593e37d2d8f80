#pragma once

#include "solver/factors/factor_matrix.h"
#include "solver/pipeline/solve.h"

namespace halfshade {

/// Radiosity that is constant on each face, from form factors by face that were computed before.
/// Nothing is computed anew: what rows of the matrix leave to space is lost, and rows are taken to
/// sum to one with it, so that power is conserved whatever they are off by. Elements are as few as
/// draw the faces, or of options.max_length; of the other options it reads `radiosity` and
/// `max_elements`. `error_estimate` is what the errors of form factors may do to the irradiance, to
/// first order and at most; that light varies across a face is no part of it. The scene need not
/// have an emitter. Throws Error(invalid_input) as require_faces_of and mutual_areas do if matrix
/// and scene do not belong together.
SolveResult solve_by_faces(const Scene& scene, const FactorMatrix& factors,
                           const SolveOptions& options = {}, const Progress& progress = {});

}  // namespace halfshade
