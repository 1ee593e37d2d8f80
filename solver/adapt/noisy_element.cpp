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
/// Standard deviations that more is no noise, of a sum of squares of it and of what it is thought
/// to be, which as many samples tell.
constexpr double sure = 2;
/// With n^-1.5 as the variance of n rays, what they can do for all elements is most with n as the
/// area to the power of .4: that is noise to the power of -.3.
constexpr double power_of_slack = 0.3, most_slack = 3;

/// No element has more samples than this.
constexpr int most_samples = 96;
/// Where this share of an element's error comes of too few samples, it gets more of them.
constexpr double few_samples = 0.5;
/// An element whose light varies by less than this share of it is worth samples for order 2.
constexpr double varies_little = 0.3;

/// An edge across an element leaves a sixth of the square of its height on the mean of all places;
/// every second neighbour of one with an edge has it, too, and n samples miss 1/(n + 1) of it.
constexpr double missed = 3;

constexpr int most_coefficients = basis_size(highest_order);
using BasisRow = Eigen::Matrix<double, most_coefficients, 1>;
/// As large as they ever are on the stack: there are very many fits.
using NormalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_coefficients, most_coefficients>;
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most_coefficients, 3>;

struct NoisyPolynomial {
  Coefficients coefficients;
  double left = 0, surely_left = 0, by_chance = std::numeric_limits<double>::infinity();
};

/// `basis` has a row of the highest order for each sample, which begins with those of lower ones.
/// Without a finite error if the samples do not tell it.
NoisyPolynomial fit_order(int order, const std::vector<NoisySample>& samples,
                          const std::vector<BasisRow>& basis, double noise) {
  const Eigen::Index size = basis_size(order);
  NormalMatrix normal = NormalMatrix::Zero(size, size);
  Coefficients moments = Coefficients::Zero(size, 3);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto row = basis[k].head(size);
    normal += row.lazyProduct(row.transpose());
    moments += row.lazyProduct(samples[k].value.mean().matrix().transpose());
  }
  const Eigen::LDLT<NormalMatrix> factors(normal);
  const NormalMatrix inverse = factors.solve(NormalMatrix::Identity(size, size));
  NoisyPolynomial result;
  result.coefficients = inverse.lazyProduct(moments);
  double spread = 0;
  for (std::size_t k = 0; k < samples.size(); ++k)
    spread += (samples[k].value.mean().matrix() -
               result.coefficients.transpose().lazyProduct(basis[k].head(size)))
                  .squaredNorm();
  const auto count = static_cast<double>(samples.size());
  const double freedom = count - static_cast<double>(size);
  spread /= freedom;
  const double trace = inverse.trace();
  if (!(factors.isPositive() && std::isfinite(spread) && trace > 0 && std::isfinite(trace)))
    return result;
  result.left = spread - noise;
  result.surely_left =
      std::max(result.left - sure * noise * std::sqrt(2 / freedom + 2 / count), 0.);
  result.by_chance = std::max(spread, noise) * trace;
  return result;
}

/// Light is not below 0, and a polynomial that is, at corners or middles of edges, is nearer to it
/// with less of all that varies. Its mean stays (Zhang and Shu 2010), unless that is below 0, too.
void keep_positive(NoisyElement& element) {
  const Eigen::Index varying = element.coefficients.rows() - 1;  // the first function is 1
  const Eigen::MatrixXd at_nodes = element_node_basis(highest_order).middleCols(1, varying) *
                                   element.coefficients.bottomRows(varying).matrix();
  for (Eigen::Index c = 0; c < 3; ++c) {
    auto column = element.coefficients.col(c);
    const double least = at_nodes.col(c).minCoeff();
    column[0] = std::max(column[0], 0.);
    if (column[0] + least < 0) column.tail(varying) *= column[0] / -least;
  }
}

}  // namespace

double known_error(std::span<const NoisyElement> elements) {
  double sum = 0;
  for (const NoisyElement& element : elements) sum += element.area * element.known_error();
  return sum;
}

double sum_of_noise(std::span<const NoisyElement> elements) {
  double sum = 0;
  for (const NoisyElement& element : elements) sum += element.area * element.noise;
  return sum;
}

double sum_of_reaches(std::span<const NoisyElement> elements) {
  double sum = 0;
  for (const NoisyElement& element : elements) sum += element.area * element.reach;
  return sum;
}

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
  double noise = 0;
  std::vector<BasisRow> basis(element.samples.size());
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const NoisySample& sample = element.samples[k];
    noise += sample.value.noise() / count;
    basis_at(highest_order, sample.place, basis[k]);
  }
  double least = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= highest_order && count >= samples_each * basis_size(order);
       ++order) {
    const NoisyPolynomial polynomial = fit_order(order, element.samples, basis, noise);
    const double square_error = polynomial.left + polynomial.by_chance;
    if (!(square_error < least)) continue;
    least = square_error;
    element.order = order;
    element.coefficients = polynomial.coefficients.array();
    element.left = polynomial.left;
    element.surely_left = polynomial.surely_left;
    element.by_chance = polynomial.by_chance;
  }
  keep_positive(element);
  element.noise = noise;
  element.is_fitted = true;
}

int next_samples(const NoisyElement& element) {
  const int now = static_cast<int>(element.samples.size());
  const double mean = element.coefficients.row(0).matrix().norm();
  const bool varies = std::sqrt(std::max(element.left, 0.)) >= varies_little * mean;
  const int enough = varies ? least_samples_of_parts : 2 * basis_size(highest_order);
  const bool too_few = element.by_chance > few_samples * element.known_error();
  if (now >= most_samples || !(too_few || now < enough)) return now;
  return std::min(std::max(2 * now, least_samples_of_parts), most_samples);
}

void suspect_unseen(std::span<const std::array<int, 3>> neighbours,
                    std::span<NoisyElement> elements) {
  for (std::size_t e = 0; e < elements.size(); ++e) {
    double seen = 0;  // by neighbours
    for (const int n : neighbours[e])
      if (n >= 0) seen += elements[at(n)].surely_left / 3;
    NoisyElement& element = elements[e];
    element.unseen = missed * std::max(seen - std::max(element.left, 0.), 0.) /
                     static_cast<double>(element.samples.size() + 1);
  }
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
