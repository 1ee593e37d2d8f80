#include "solver/exchange/patch_factors.h"

#include "meshing/core/parallel.h"
#include "solver/exchange/factor_rows.h"

#include <utility>
#include <vector>

namespace halfshade {

PatchFactors patch_factors(const SoundScene& scene, const ElementTable& patches,
                           const ElementTable& elements, const VisibilityIndex& visibility,
                           const ExchangeOptions& options, const Progress& progress) {
  constexpr int centroid = 1;
  const FactorRowFiller fill =
      make_row_filler(scene, patches, visibility, options, centroid, progress);
  std::vector<std::vector<std::pair<int, double>>> rows(elements.corners.size());
  const auto fill_row = [&](std::size_t e) {
    std::vector<double> factors(patches.corners.size());
    fill({elements.triangle(static_cast<int>(e)), elements.normal[e], elements.surface[e]},
         factors);
    for (int p = 0; p < patches.count(); ++p)
      if (factors[at(p)] > 0) rows[e].emplace_back(p, factors[at(p)]);
  };
  if (!parallel_for(rows.size(), fill_row, progress, "form factors of elements")) return {};
  PatchFactors matrix(elements.count(), patches.count());
  for (Eigen::Index e = 0; e < matrix.rows(); ++e) {
    matrix.startVec(e);
    for (const auto& [p, factor] : rows[static_cast<std::size_t>(e)])
      matrix.insertBack(e, p) = factor;
  }
  matrix.finalize();
  return matrix;
}

}  // namespace halfshade
