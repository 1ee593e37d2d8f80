#pragma once

#include "solver/elements/element_field.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace halfshade {

/// How elements are cut into straight triangles, and what that costs.
struct StraightCut {
  std::vector<int> along_edge;  ///< pieces along each edge, of each element: its square in all
  Eigen::ArrayXd off;           ///< root mean square over each element, in the field's unit
  double relative_error = 0;    ///< of all, in the L2 norm, relative to the field's
  bool is_limited = false;      ///< more is off than allowed, for there may be no more pieces

  long long pieces() const;
};

/// Cuts so that straight lines between the corners are off by at most `allowed` in the L2 norm over
/// all elements, relative to the field's, with about as few pieces as that takes: each adds about
/// as much. No more than `most_pieces`, unless there are more elements. The error is exact.
StraightCut straight_cut(const ElementField& field, std::span<const double> areas, double allowed,
                         int most_pieces);

}  // namespace halfshade
