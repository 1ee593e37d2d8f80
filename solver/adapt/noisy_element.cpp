#include "solver/adapt/noisy_element.h"

#include "solver/elements/element_field.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr int highest_order = 2;
/// Samples for one coefficient, at least.
constexpr int samples_each = 2;
/// Standard deviations of a sum of squares of noise that more is no noise.
constexpr double sure = 2;
/// With n^-1.5 as the variance of n rays, what they can do for all elements is most with n as the
/// area to the power of .4: that is noise to the power of -.3, and less than twice as much of it in
/// all as without any slack.
constexpr double power_of_slack = 0.3, most_slack = 16;

struct NoisyPolynomial {
  ChannelArray coefficients;
  double left = 0, surely_left = 0, by_chance = std::numeric_limits<double>::infinity();
};

/// Without a finite error if the samples do not tell it.
NoisyPolynomial fit_order(int order, const std::vector<NoisySample>& samples, double noise) {
  NoisyPolynomial result;
  const auto count = static_cast<Eigen::Index>(samples.size());
  const Eigen::Index size = basis_size(order);
  Eigen::MatrixXd basis(count, size);
  ChannelArray values(count, 3);
  Eigen::VectorXd row(size);
  for (Eigen::Index k = 0; k < count; ++k) {
    const NoisySample& sample = samples[static_cast<std::size_t>(k)];
    basis_at(order, sample.place, row);
    basis.row(k) = row;
    values.row(k) = sample.value.mean();
  }
  const Eigen::LDLT<Eigen::MatrixXd> normal(basis.transpose() * basis);
  const Eigen::MatrixXd inverse = normal.solve(Eigen::MatrixXd::Identity(size, size));
  result.coefficients = (inverse * (basis.transpose() * values.matrix())).array();
  const double spread = (values.matrix() - basis * result.coefficients.matrix()).squaredNorm() /
                        static_cast<double>(count - size);
  const double trace = inverse.trace();
  if (!(normal.isPositive() && std::isfinite(spread) && trace > 0 && std::isfinite(trace)))
    return result;
  result.left = spread - noise;
  const double deviation = noise * std::sqrt(2 / static_cast<double>(count - size));
  result.surely_left = std::max(result.left - sure * deviation, 0.);
  result.by_chance = std::max(spread, noise) * trace;
  return result;
}

}  // namespace

double slack_of(const NoisyElement& element, double mean_area) {
  return std::clamp(std::pow(mean_area / element.area, power_of_slack), 1., most_slack);
}

Rgb value_at(const NoisyElement& element, const TrianglePlace& place) {
  Eigen::VectorXd phi(element.coefficients.rows());
  basis_at(element.order, place, phi);
  return (element.coefficients.matrix().transpose() * phi).array();
}

void fit(NoisyElement& element) {
  const int count = static_cast<int>(element.samples.size());
  double noise = 0;  // variance of a mean of two values
  for (const NoisySample& sample : element.samples)
    noise += (sample.value.a - sample.value.b).matrix().squaredNorm() / 4 / count;
  double least = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= highest_order && count >= samples_each * basis_size(order);
       ++order) {
    NoisyPolynomial polynomial = fit_order(order, element.samples, noise);
    const double square_error = polynomial.left + polynomial.by_chance;
    if (!(square_error < least)) continue;
    least = square_error;
    element.order = order;
    element.coefficients = std::move(polynomial.coefficients);
    element.left = polynomial.left;
    element.surely_left = polynomial.surely_left;
    element.by_chance = polynomial.by_chance;
  }
  element.is_fitted = true;
}

void share_samples(const NoisyElement& whole, std::span<const int> parts,
                   std::span<NoisyElement> elements) {
  for (const NoisySample& sample : whole.samples) {
    const Vec3 point = position(whole.triangle, sample.place);
    int best = -1;
    double deepest = -std::numeric_limits<double>::infinity();
    TrianglePlace place;
    for (const int part : parts) {
      const TrianglePlace here = place_of(elements[at(part)].triangle, point);
      const double depth = std::min({here.x(), here.y(), 1 - here.sum()});
      if (depth <= deepest) continue;
      deepest = depth;
      best = part;
      place = here;
    }
    if (best >= 0) elements[at(best)].samples.push_back({place, sample.value});
  }
}

}  // namespace halfshade
