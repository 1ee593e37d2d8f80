#pragma once

#include "solver/factors/factor_matrix.h"

namespace halfshade {

/// Throws Error(invalid_input) in the name of the matrix's source if an entry is negative or a row
/// is not its sum: Σ F + space, with what was left out, is row_sum, or one; and that is one as far
/// as errors of the entries allow.
void require_rows_that_add_up(const FactorMatrix& saved);

/// A F of a matrix that was written and read again: its two halves, which differ by rounding,
/// averaged. Throws Error(invalid_input) in the name of its source if they differ by more.
RowMajorMatrix mutual_areas(const FactorMatrix& saved);

/// Throws Error(invalid_input) in the name of the matrix's source unless its rows are those of
/// `scene`, which is by face: as many, with the same names and areas, in the same places if it
/// tells them.
void require_faces_of(const FactorScene& scene, const FactorMatrix& saved);

/// What form_factor_matrix finds by options.unit, summed from a matrix by face; options.enforce and
/// options.sparse_below hold for the sums. Errors are bounds that follow from those of the faces,
/// `row_sum` is their mean by area, `backs` is not known and 0. Throws as require_faces_of and
/// mutual_areas. Cost: that of making the scene sound, and the matrix read once.
FactorMatrix summed_factors(const Scene& scene, const FactorMatrix& saved,
                            const FactorOptions& options);

}  // namespace halfshade
