#pragma once

#include "solver/elements/element_field.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Triangles with values at corners that stand for polynomials on larger ones.
struct LinearPieces {
  std::vector<Vec3> points;
  std::vector<Rgb> value;  ///< at each point
  std::vector<int> element_of_point;
  std::vector<std::array<int, 3>> corners;
  /// [k]: whether the edge from corner k to k+1 lies on the element's border.
  std::vector<std::array<bool, 3>> is_border;
  std::vector<int> element;  ///< that each piece is of
  std::vector<int> pieces;   ///< that each element has
};

/// Cuts each element evenly, its edges into so many pieces. Elements share no points.
LinearPieces linear_pieces(std::span<const std::array<Vec3, 3>> triangles,
                           const ElementField& field, std::span<const int> along_edge);

/// The same for the eye: so finely that straight lines between the corners are off by about
/// `allowed` (root mean square, in the field's unit) at most, unless that takes more than 256
/// pieces. See straight_cut where an error is to be kept.
LinearPieces linear_pieces(std::span<const std::array<Vec3, 3>> triangles,
                           const ElementField& field, double allowed);

/// The share of a field that nobody sees.
inline constexpr double invisible_share = 1e-3;

}  // namespace halfshade
