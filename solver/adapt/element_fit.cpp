#include "solver/adapt/element_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// What degrees beyond those sampled may add to an error, at most, as a factor of it.
constexpr double most_unseen = 1.6;
/// Degrees with less than this share of the light are rounding, and nothing.
constexpr double share_of_rounding = 1e-13;

/// Per order, the basis of the next one at the places of its sampling rule.
struct SamplingBases {
  std::array<Eigen::MatrixXd, max_order + 1> of_order;

  SamplingBases() {
    for (int order = 0; order <= max_order; ++order)
      of_order[at(order)] = basis_at(order + 1, sampling_rule(order).places);
  }
};

const Eigen::MatrixXd& sampling_basis(int order) {
  static const SamplingBases bases;
  return bases.of_order[at(order)];
}

}  // namespace

const TriangleRule& sampling_rule(int order) { return gauss_rule(2 * order + 2); }

ElementFit fit_element(int order, const ChannelArray& samples) {
  const Eigen::MatrixXd& basis = sampling_basis(order);
  const Eigen::VectorXd& weights = sampling_rule(order).weights;
  const Eigen::Matrix<double, Eigen::Dynamic, 3> all =
      basis.transpose() * weights.asDiagonal() * samples.matrix();
  ElementFit fit;
  fit.order = order;
  for (int degree = 0; degree <= order + 1; ++degree)
    if (const double size = all.middleRows(basis_size(degree - 1), degree + 1).norm();
        size > share_of_rounding * fit.layer[0])
      fit.layer[at(degree)] = size;
  const int size = basis_size(order);
  fit.coefficients = all.topRows(size).array();
  const Eigen::MatrixXd rest = samples.matrix() - basis.leftCols(size) * all.topRows(size);
  const auto places = static_cast<double>(weights.size());
  fit.error = std::sqrt(weights.dot(rest.rowwise().squaredNorm()) * places / (places - size));
  // Degrees beyond those that samples tell, if they go on to shrink as they do.
  const double shrinks = order > 0 ? decay(fit) : 0;
  fit.error *= std::min(1 / std::sqrt(1 - shrinks * shrinks), most_unseen);
  return fit;
}

double decay(const ElementFit& fit) {
  if (fit.order < 1) return 1;
  // Over two degrees, for even and odd ones may differ.
  const double low = fit.layer[at(fit.order - 1)], high = fit.layer[at(fit.order + 1)];
  const double middle = fit.layer[at(fit.order)];
  if (high == 0) return 0;
  return std::max(std::sqrt(high / std::max(low, high)), 0.5 * high / std::max(middle, high));
}

ElementFit restrict_fit(const ElementFit& whole, const std::array<TrianglePlace, 3>& corners) {
  ElementFit part = whole;
  part.coefficients = (restriction(whole.order, corners) * whole.coefficients.matrix()).array();
  return part;
}

void lower_order(ElementFit& fit) {
  fit.error = std::hypot(fit.error, fit.layer[at(fit.order)]);
  --fit.order;
  fit.coefficients.conservativeResize(basis_size(fit.order), 3);
}

}  // namespace halfshade
