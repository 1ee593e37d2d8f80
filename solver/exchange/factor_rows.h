#pragma once

#include "meshing/core/progress.h"
#include "solver/exchange/exchange.h"

#include <array>
#include <functional>
#include <span>

namespace halfshade {

/// What factors are from.
struct FactorViewer {
  std::array<Vec3, 3> triangle;
  Vec3 normal;  ///< unit length
  int surface = 0;
};

/// Adds the factors from a viewer to all elements, zero on entry. May be called concurrently.
using FactorRowFiller = std::function<void(const FactorViewer& viewer, std::span<double> factors)>;

/// With FactorsBy::hemicube by a hemicube at the viewer's centroid; else by closed forms on exactly
/// visible parts, in the mean over the symmetric rule of `degree` on the viewer, see
/// triangle_rule: 4 has six points, 1 the centroid. Refers to all but the options.
FactorRowFiller make_row_filler(const SoundScene& scene, const ElementTable& elements,
                                const VisibilityIndex& visibility, const ExchangeOptions& options,
                                int degree, const Progress& progress);

}  // namespace halfshade
