#pragma once

#include "solver/factors/factor_matrix.h"
#include "solver/factors/mutual_sight.h"

#include <cstddef>
#include <optional>

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

/// By rays from rows, of equal form factor each: places and directions are points of scrambled
/// sequences, sixteen for each row, which go on until what they differ by is within
/// options.tolerance, or as far as options.rays says. Both directions of a pair are weighed by how
/// exact their rows are. Errors are four standard errors.
RowExchange sampled_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                             const FactorOptions& options, const Progress& progress);

/// The same to options.tolerance, or nothing if it takes more than so many rays in all: told after
/// few of them where it takes far more.
std::optional<RowExchange> sampled_exchange_within(std::size_t rays, const FactorScene& scene,
                                                   const ReflectingScene& reflecting,
                                                   const FactorOptions& options,
                                                   const Progress& progress);

/// By hemicubes of options.hemicube_pixels at places spread over the surfaces, at least four each;
/// both directions of a pair are weighed by their areas. Errors are three standard errors of what
/// hemicubes see differently, and never less than a pixel.
RowExchange hemicube_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                              const FactorOptions& options, const Progress& progress);

}  // namespace halfshade
