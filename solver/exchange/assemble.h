#pragma once

#include "meshing/core/progress.h"
#include "solver/exchange/cells.h"
#include "solver/exchange/exchange.h"

#include <cstddef>
#include <vector>

namespace halfshade {

struct AssembledFactors {
  ExchangeMatrix matrix;
  std::size_t rays = 0;
  std::size_t refined_rows = 0;  ///< that took more rays, for their sums were off
  bool complete = true;          ///< false if stopped
  std::vector<char> is_missing;  ///< row → its part right of the diagonal was not reached
};

/// The matrix of compute_exchange before closure is enforced.
AssembledFactors assemble_factors(const SoundScene& scene, const ElementTable& elements,
                                  const SpaceCells& cells, const VisibilityIndex& visibility,
                                  const ExchangeOptions& options, const Progress& progress);

}  // namespace halfshade
