#pragma once

#include "solver/reflected/reflected_mesh.h"

#include <cstdint>
#include <vector>

namespace halfshade {

/// A random place where an error is looked at.
struct ProbePlace {
  int element;
  TrianglePlace place;
  double share;                         ///< of the area that it stands for
  std::uint64_t seed;                   ///< for more random numbers
  double weight = 1;                    ///< of |error|²
  double square_error = 0, square = 0;  ///< found there: |error|² and |H_d + G|²
};

/// About so many over all elements: the largest errors are those of small elements beside contacts,
/// so that there are as many as the square root of the area, in the mean over `use`; no element is
/// given nearly all.
/// `weight` has an entry for each element.
std::vector<ProbePlace> spread_probes(const ReflectedMesh& mesh, const std::vector<double>& weight,
                                      int points, int use);

}  // namespace halfshade
