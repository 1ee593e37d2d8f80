#pragma once

#include "solver/factors/factor_matrix.h"
#include "solver/factors/surface_exchange.h"

namespace halfshade {

/// The form factors of an exchange between rows, scaled and made sparse as the options say. Rows
/// with an error above `tolerance` count as not reached.
FactorMatrix finished_matrix(const FactorScene& scene, const RowExchange& exchange,
                             double tolerance, const FactorOptions& options);

}  // namespace halfshade
