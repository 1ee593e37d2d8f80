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
  double square_error = 0, square = 0;  ///< found there: |error|² and its square_beside_known
  Rgb missing = Rgb::Zero();            ///< what arrives and is not in the solution
  double reach = 1;                     ///< share of what leaves the place that arrives somewhere
};

/// The share of probes that each element is to have: the largest errors are those of small elements
/// beside contacts, so that they are as the square root of the area, and no element is given nearly
/// all. Where it is known about how large the square error of each is, half of them are as
/// its root: what is expected is not sure.
std::vector<double> shares_of_probes(const ReflectedMesh& mesh,
                                     const std::vector<double>& expected = {});

/// About so many over all elements, in the mean over `use`. `weight` and `shares` have an entry for
/// each element.
std::vector<ProbePlace> spread_probes(const ReflectedMesh& mesh, const std::vector<double>& weight,
                                      const std::vector<double>& shares, int points, int use);

}  // namespace halfshade
