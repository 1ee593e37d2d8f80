#pragma once

#include "solver/elements/polynomial.h"
#include "solver/elements/quadrature.h"
#include "solver/elements/solution.h"

#include <Eigen/Core>

#include <array>

namespace halfshade {

/// A polynomial through samples of a function on a triangle, and what they tell of its error.
struct ElementFit {
  int order = 0;
  ChannelArray coefficients;  ///< see basis_at
  /// Root mean square over the triangle of what each degree adds, the channels' squares summed; up
  /// to one above the order.
  std::array<double, max_order + 2> layer{};
  double error = 0;  ///< root mean square of function less polynomial, estimated
};

/// Where a function is sampled to be fitted with a polynomial of that order: Gauss's places, enough
/// for the next order, too.
const TriangleRule& sampling_rule(int order);

/// Least squares with the rule's weights; `samples` has a row for each of its places. The error is
/// that at the samples, put up for the freedom that the polynomial had to follow them: right for
/// functions with breaks, and for smooth ones somewhat more than the next degrees add.
ElementFit fit_element(int order, const ChannelArray& samples);

/// By how much the layers shrink from degree to degree, at the top; smooth functions below 1/2.
/// 1 for orders that are too low to tell.
double decay(const ElementFit& fit);

/// The polynomial on a part of the triangle, with the same error.
ElementFit restrict_fit(const ElementFit& whole, const std::array<TrianglePlace, 3>& corners);

/// Drops the top degree: the error grows by its layer. The order must be above 0.
void lower_order(ElementFit& fit);

}  // namespace halfshade
