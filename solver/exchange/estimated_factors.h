#pragma once

#include "meshing/rays/visibility.h"
#include "solver/elements/solution.h"
#include "solver/exchange/cells.h"
#include "solver/exchange/exchange.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Factors that were not computed, from rays.
struct EstimatedFactors {
  ExchangeMatrix matrix;    ///< A_i F(i,j), symmetric
  ExchangeMatrix variance;  ///< of its entries
  std::size_t rays = 0;
};

/// Estimates the factors of all pairs i < j of which `is_missing[i]` says that the row was not
/// reached. Rays leave each element as diffuse light does, and carry its area in equal parts to
/// what they meet first; the two directions of a pair are averaged, which keeps reciprocity.
/// Without bias. Deterministic for the same rows. Takes about a second, or sixteen rays an element
/// if that takes longer.
EstimatedFactors estimate_factors(const SoundScene& scene, const ElementTable& elements,
                                  const SpaceCells& cells, const VisibilityIndex& visibility,
                                  const std::vector<char>& is_missing);

/// What estimated factors make the irradiance of each element uncertain by, in W/m²: the standard
/// deviation, in the L2 mean over the channels, of light that has `radiosity` and arrives without
/// further reflections. Zero where no factor is estimated.
Eigen::ArrayXd estimation_error(const Exchange& exchange, const ChannelArray& radiosity);

}  // namespace halfshade
