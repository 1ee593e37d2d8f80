#pragma once

#include "solver/pipeline/solve.h"

#include <array>
#include <vector>

namespace halfshade {

/// A result for those who know triangles with values at corners only.
struct LinearResult {
  ElementTable elements;
  /// See LinearPieces; empty if elements were not cut.
  std::vector<std::array<bool, 3>> is_border;
  Solution solution;                   ///< of each triangle
  ChannelArray irradiance, radiosity;  ///< at points, W/m²
  /// There: direct light, that reflected once, twice, …; if SolveOptions::each_bounce.
  std::vector<ChannelArray> bounces;
  std::vector<Region> regions;  ///< as those of SolveResult
  double relative_error = 0;    ///< of the polynomials and of what the triangles miss of them
};

/// A result with the polynomials of its elements, by their values at nodes.
struct NodeValues {
  std::vector<int> order;              ///< of each element; 1 also where it is constant
  std::vector<Vec3> points;            ///< one element's after the other's, see element_nodes
  ChannelArray irradiance, radiosity;  ///< there, W/m²
  std::vector<ChannelArray> bounces;   ///< as those of LinearResult
};

/// Precondition: the result has polynomials.
NodeValues node_values(const SolveResult& result);

/// Cuts elements of higher order into triangles, as SolveResult::straight has it, or else so many
/// that straight lines between their corners add little to the result's error or a thousandth of
/// its light. Errors are those of the triangles. Constant elements stay as they are; values at
/// points are then means of the elements around them.
LinearResult linear_result(const SolveResult& result);

/// The same for somebody who looks at it, with no more triangles than that takes: polynomials are
/// made continuous first, see join.
LinearResult joined_linear_result(const SolveResult& result);

}  // namespace halfshade
