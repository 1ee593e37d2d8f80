#pragma once

#include "solver/factors/factor_matrix.h"
#include "solver/factors/surface_exchange.h"

namespace halfshade {

/// The form factors of an exchange between rows, made sparse and then scaled as the options say.
/// Rows with an error above `tolerance` count as not reached.
FactorMatrix finished_matrix(const FactorScene& scene, RowExchange exchange, double tolerance,
                             const FactorOptions& options);

}  // namespace halfshade
