#pragma once

#include "solver/factors/factor_matrix.h"
#include "solver/factors/mutual_sight.h"

namespace halfshade {

/// Mutual areas of all surfaces of a scene, summed into rows.
struct RowExchange {
  RowMajorMatrix mutual;        ///< A_i F(i,j), symmetric to the bit, squared scene units
  RowMajorMatrix mutual_error;  ///< bounds of their errors
  Eigen::ArrayXd space, backs;  ///< the same to the surroundings, and to unused backs
  Eigen::ArrayXd space_error;   ///< of the two together
  FactorReport report;

  explicit RowExchange(int rows)
      : mutual(RowMajorMatrix::Zero(rows, rows)),
        mutual_error(mutual),
        space(Eigen::ArrayXd::Zero(rows)),
        backs(space),
        space_error(space) {}

  /// Adds what two surfaces of these rows (or `surroundings`, `unused_back`) see of each other.
  void add(int row, int other, double value, double error);
  void add(int row, int other, Sight sight, const MutualSight& seen);
};

/// By closed forms and exactly visible parts.
RowExchange exact_exchange(const FactorScene& scene, const SightScene& sight,
                           const FactorOptions& options, const Progress& progress);

/// By rays, of equal form factor each, in strata; both directions of a pair are weighed by
/// their rays. Errors are three standard errors, of counts as if rays were independent.
RowExchange sampled_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                             const FactorOptions& options, const Progress& progress);

/// By hemicubes of options.hemicube_pixels at places spread over the surfaces, at least four each;
/// both directions of a pair are weighed by their areas. Errors are three standard errors of what
/// hemicubes see differently, and never less than a pixel.
RowExchange hemicube_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                              const FactorOptions& options, const Progress& progress);

}  // namespace halfshade
