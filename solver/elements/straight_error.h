#pragma once

#include "solver/elements/element_field.h"

#include <Eigen/Core>

#include <vector>

namespace halfshade {

/// How far straight triangles are from the polynomials that they are cut from, see linear_pieces:
/// exactly, for any number of pieces. Values at corners are the polynomials'.
class StraightError {
 public:
  /// `scale` is what the field's values are multiplied with, so that squares stay in range.
  StraightError(const ElementField& field, double scale);

  /// Mean over an element of the squared distance, the channels' summed, where its edges are cut
  /// into `along_edge` ≥ 1 pieces.
  double mean_square(int element, int along_edge);

  int count() const { return static_cast<int>(of_few_.cols()); }

 private:
  const Eigen::VectorXd& weights(int along_edge);

  Eigen::MatrixXd of_few_;  ///< one column an element: with edges cut into 1, 2, … pieces
  std::vector<Eigen::VectorXd> weights_;  ///< of those, for any number of pieces; made when needed
};

}  // namespace halfshade
