#pragma once

#include "solver/exchange/assemble.h"

namespace halfshade {

/// The matrix of compute_exchange, before closure is enforced, from what points of elements see:
/// with FactorsBy::hemicube by a hemicube at the centroid, with FactorsBy::exact by closed forms on
/// exactly visible parts, in the mean over a rule of degree 4. A point sees the other element
/// exactly, or as well as pixels go, but stands for the whole of its own: factors of neighbours are
/// off by as much as they change over it. Each entry is the mean of A_i F(i,j) and A_j F(j,i), for
/// solvers want reciprocity. Nothing is kept if stopped: all rows are missing then.
AssembledFactors factors_from_points(const SoundScene& scene, const ElementTable& elements,
                                     const SpaceCells& cells, const VisibilityIndex& visibility,
                                     const ExchangeOptions& options, const Progress& progress);

}  // namespace halfshade
