#pragma once

#include "solver/adapt/element_fit.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/element_field.h"

#include <cmath>
#include <span>

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

inline FieldPoint point_at(const FittedElement& element, const TrianglePlace& place) {
  return {{position(element.triangle, place), element.normal}, element.surface};
}

inline Rgb fitted_at(const FittedElement& element, const TrianglePlace& place) {
  Eigen::VectorXd phi(element.fit.coefficients.rows());
  basis_at(element.fit.order, place, phi);
  return (element.fit.coefficients.matrix().transpose() * phi).array();
}

/// Root mean square, over places, of given values less fitted ones, the channels' squares summed.
inline double error_at(const FittedElement& element, std::span<const TrianglePlace> places,
                       std::span<const Rgb> values) {
  double square = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    square += (values[k] - fitted_at(element, places[k])).square().sum();
  return std::sqrt(square / static_cast<double>(places.size()));
}

/// Gives an element an order that it is yet to be fitted with.
inline void set_order(FittedElement& element, int order) {
  element.fit.order = order;
  element.fit.coefficients.conservativeResizeLike(ChannelArray::Zero(basis_size(order), 3));
  element.is_fitted = false;
}

}  // namespace halfshade
