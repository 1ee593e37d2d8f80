#pragma once

#include "solver/exchange/form_factor.h"

#include <optional>
#include <vector>

namespace halfshade {

/// Places in a polygon, and weights that sum to its area.
struct AreaRule {
  int degree = 0;       ///< of the polynomials for which it is exact
  double left_out = 0;  ///< size of the first term for which it is not
  std::vector<double> x, y, z, weight;
};

/// A triangle or parallelogram with rules for what it exchanges with others that are far off.
struct FarPiece {
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
  double radius = 0;            ///< of a ball round the centre that holds it
  double area = 0;              ///< squared scene units
  std::vector<Vec3> corners;    ///< counter-clockwise
  std::vector<AreaRule> rules;  ///< of rising degree; none of other polygons
};

FarPiece far_piece(const std::vector<Vec3>& corners);

/// Mutual area of two that nothing comes between, by a rule over each: a tenth of what mutual_area
/// takes, or less. Nothing unless each lies in front of the other, and rules are enough for an
/// error within `options.floor` or `options.tolerance`.
std::optional<MutualArea> far_area(const FarPiece& p, const FarPiece& q,
                                   const FormFactorOptions& options);

}  // namespace halfshade
