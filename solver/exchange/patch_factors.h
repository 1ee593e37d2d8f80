#pragma once

#include "solver/exchange/exchange.h"

namespace halfshade {

/// Form factors from elements to patches: F(element, patch), zeros left out.
using PatchFactors = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// What the centroids of elements see of patches, which are coarser elements of the same scene: by
/// hemicubes with FactorsBy::hemicube, else exactly. If stopped, the matrix is empty. Cost: a
/// hemicube, or a look at each surface, for each element.
PatchFactors patch_factors(const SoundScene& scene, const ElementTable& patches,
                           const ElementTable& elements, const VisibilityIndex& visibility,
                           const ExchangeOptions& options, const Progress& progress = {});

}  // namespace halfshade
