#include "solver/reflected/field_noise.h"

#include <cmath>

namespace halfshade {

ChannelArray means_of_halves(const ChannelArray& halves) {
  ChannelArray means(halves.rows() / 2, 3);
  for (Eigen::Index k = 0; k < means.rows(); ++k)
    means.row(k) = 0.5 * (halves.row(2 * k) + halves.row(2 * k + 1));
  return means;
}

double rays_as_good_as(double a, double b) {
  return std::pow(std::pow(a, noise_exponent) + std::pow(b, noise_exponent), 1 / noise_exponent);
}

double rays_missing(double wanted, double sent) {
  if (wanted <= sent) return 0;
  return std::pow(std::pow(wanted, noise_exponent) - std::pow(sent, noise_exponent),
                  1 / noise_exponent);
}

FieldNoise::value_type noise_of_halves(const ElementNodes& nodes, double area,
                                       const ChannelArray& halves) {
  FieldNoise::value_type noise{};
  for (Eigen::Index k = 0; k < nodes.spread.cols(); ++k) {
    const double variance = 0.25 * (halves.row(2 * k) - halves.row(2 * k + 1)).square().sum();
    for (Eigen::Index d = 0; d < nodes.spread.rows(); ++d)
      noise[static_cast<std::size_t>(d)] += area * nodes.spread(d, k) * variance;
  }
  return noise;
}

FieldNoise::value_type mean_noise(const FieldNoise::value_type& a, const FieldNoise::value_type& b,
                                  double share_of_b) {
  const double of_a = (1 - share_of_b) * (1 - share_of_b), of_b = share_of_b * share_of_b;
  FieldNoise::value_type noise{};
  for (std::size_t d = 0; d < noise.size(); ++d) noise[d] = of_a * a[d] + of_b * b[d];
  return noise;
}

std::vector<double> noise_of_elements(const FieldNoise& noise, const std::vector<double>& weight) {
  std::vector<double> result;
  for (std::size_t e = 0; e < noise.size(); ++e) {
    double sum = 0;
    for (const double n : noise[e]) sum += n;
    result.push_back(weight[e] * sum);
  }
  return result;
}

}  // namespace halfshade
