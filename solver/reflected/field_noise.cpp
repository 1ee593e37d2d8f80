#include "solver/reflected/field_noise.h"

#include <algorithm>

namespace halfshade {
namespace {

/// What is no noise of a square that has some.
double signal(double square, double noise) { return std::max(square - noise, 0.); }

/// The share of noise that is left where a share of the field is kept. Some of what is taken for
/// noise is none.
double left_of_noise(double kept) {
  constexpr double least = 0.15;
  return least + (1 - least) * kept;
}

/// The square of the polynomials of one degree on an element.
double square_of(const ReflectedMesh& mesh, const ElementField& field, int e, int degree) {
  return mesh.area(e) * field.of(e).middleRows(basis_size(degree - 1), degree + 1).square().sum();
}

}  // namespace

ChannelArray means_of_halves(const ChannelArray& halves) {
  ChannelArray means(halves.rows() / 2, 3);
  for (Eigen::Index k = 0; k < means.rows(); ++k)
    means.row(k) = 0.5 * (halves.row(2 * k) + halves.row(2 * k + 1));
  return means;
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

QuietField without_noise(const ReflectedMesh& mesh, ElementField field, const FieldNoise& noise) {
  QuietField quiet{std::move(field), noise};
  for (int e = 0; e < mesh.count(); ++e)
    for (int d = 1; d <= quiet.field.order[at(e)]; ++d) {
      double& off = quiet.noise[at(e)][at(d)];
      const double square = square_of(mesh, quiet.field, e, d);
      const double keep = square > 0 ? signal(square, off) / square : 1;
      quiet.field.of(e).middleRows(basis_size(d - 1), d + 1) *= keep;
      off *= left_of_noise(keep);
    }
  return quiet;
}

double noise_left(const ReflectedMesh& mesh, const ElementField& field, const FieldNoise& noise,
                  const std::vector<double>& weight, double rays) {
  double sum = 0;
  for (int e = 0; e < mesh.count(); ++e)
    for (int d = 0; d <= field.order[at(e)]; ++d) {
      const double now = noise[at(e)][at(d)], then = now / rays;
      const double own = signal(square_of(mesh, field, e, d), now);
      const double kept = d == 0 ? 1 : own + then > 0 ? own / (own + then) : 0;
      sum += weight[at(e)] * then * left_of_noise(kept);
    }
  return sum;
}

}  // namespace halfshade
