#pragma once

#include "solver/factors/factor_scene.h"
#include "solver/reflected/hemisphere_rays.h"

#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Places of a row of a form-factor matrix, all its surfaces together, by area.
class RowPlaces {
 public:
  /// `roots` are the triangles of the row's surfaces; `scene` must outlive it.
  RowPlaces(const ReflectingScene& scene, std::vector<int> roots);

  /// The place that two numbers from 0 to less than 1 stand for, equal areas for equal areas.
  RayOrigin at_numbers(double u, double v) const;

 private:
  const ReflectingScene* scene_;
  std::vector<int> roots_;
  std::vector<double> area_;  ///< of all roots up to the same place, squared scene units
};

/// The triangles of each row of a matrix.
std::vector<std::vector<int>> roots_of_rows(const FactorScene& scene,
                                            const ReflectingScene& reflecting);

/// Some points of a scrambled sequence in four dimensions, each a place and a direction.
struct RowRays {
  std::uint64_t seed;
  std::uint32_t first, last;
};

/// Counts where rays from a row end: `hits` has the rows of the matrix, then the surroundings, then
/// unused backs.
void count_rays(const FactorScene& scene, const ReflectingScene& reflecting, const RowPlaces& from,
                const RowRays& rays, std::span<std::uint32_t> hits);

}  // namespace halfshade
