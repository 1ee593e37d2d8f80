#pragma once

#include "solver/adapt/element_fit.h"
#include "solver/elements/element_field.h"

namespace halfshade {

/// An element of an adaptive field while it is made.
struct FittedElement {
  std::array<Vec3, 3> triangle;
  Vec3 normal;
  int surface = 0;
  double area = 0;
  double weight = 1;
  ElementFit fit;
  bool is_fitted = false, is_checked = false;
  bool is_broken = false;  ///< its samples overlook something

  double square_error() const { return area * weight * fit.error * fit.error; }
};

inline Rgb fitted_at(const FittedElement& element, const TrianglePlace& place) {
  Eigen::VectorXd phi(element.fit.coefficients.rows());
  basis_at(element.fit.order, place, phi);
  return (element.fit.coefficients.matrix().transpose() * phi).array();
}

}  // namespace halfshade
