#include "solver/exchange/point_factors.h"

#include "meshing/core/parallel.h"
#include "solver/exchange/factor_rows.h"

#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Of the rule that averages exact factors over an element: six points.
constexpr int rule_degree = 4;

struct PointFactorEntry {
  int column;
  double value;
};
using FactorRows = std::vector<std::vector<PointFactorEntry>>;

/// The mean of the matrix of these rows, which are sorted, and its transpose.
ExchangeMatrix reciprocal(FactorRows rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  std::size_t count = 0;
  for (const auto& row : rows) count += row.size();
  ExchangeMatrix one_way(n, n);
  one_way.reserve(static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < n; ++i) {
    one_way.startVec(i);
    for (const PointFactorEntry& entry : rows[static_cast<std::size_t>(i)])
      one_way.insertBack(i, entry.column) = entry.value;
    rows[static_cast<std::size_t>(i)] = {};
  }
  one_way.finalize();
  const ExchangeMatrix other_way = one_way.transpose();
  return 0.5 * (one_way + other_way);
}

}  // namespace

AssembledFactors factors_from_points(const SoundScene& scene, const ElementTable& elements,
                                     const SpaceCells& cells, const VisibilityIndex& visibility,
                                     const ExchangeOptions& options, const Progress& progress) {
  const FactorRowFiller fill =
      make_row_filler(scene, elements, visibility, options, rule_degree, progress);
  const std::size_t n = elements.corners.size();
  FactorRows rows(n);
  const auto fill_row = [&](std::size_t i) {
    const int element = static_cast<int>(i);
    std::vector<double> factors(n, 0);
    fill({elements.triangle(element), elements.normal[i], elements.surface[i]}, factors);
    for (int j = 0; j < static_cast<int>(n); ++j)
      if (factors[at(j)] > 0 && cells.before(j) == cells.before(element))
        rows[i].push_back({j, elements.area[i] * factors[at(j)]});
  };
  AssembledFactors result;
  result.complete = parallel_for(n, fill_row, progress, "form factors");
  result.is_missing.assign(n, result.complete ? 0 : 1);
  if (!result.complete) rows.assign(n, {});
  result.matrix = reciprocal(std::move(rows));
  if (options.factors == FactorsBy::hemicube)
    result.rays = n * static_cast<std::size_t>(options.hemicube_pixels) *
                  static_cast<std::size_t>(options.hemicube_pixels) * 3;
  return result;
}

}  // namespace halfshade
