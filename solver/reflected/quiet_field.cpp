#include "solver/reflected/quiet_field.h"

#include "solver/reflected/forest_field.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
namespace {

using Noise = FieldNoise::value_type;

double sum_of(const Noise& noise) { return std::accumulate(noise.begin(), noise.end(), 0.); }

/// What is kept of a part of a field, and the noise that is left in it.
struct Kept {
  double share, noise;
};

/// `square` and `noise` as found, both ∫ of squares; the filter for `rays` times as many rays.
Kept kept_of(double square, double noise, double rays) {
  constexpr double least = 0.05;  // some of what is taken for noise is none
  const double own = std::max(square - noise, 0.), then = noise / rays;
  const double share = own + then > 0 ? own / (own + then) : 1;
  return {share, then * (least + (1 - least) * share)};
}

/// Of a polynomial of a half, the noise in that of the whole: each degree's is spread evenly over
/// its coefficients.
void add_to_whole(const Eigen::MatrixXd& restriction, int order, const Noise& half, Noise& whole) {
  for (int j = 0; j <= order; ++j) {
    const double each = 0.5 * half[at(j)] / (j + 1);
    for (int d = 0; basis_size(d) <= restriction.cols(); ++d)
      whole[at(d)] +=
          each *
          restriction.block(basis_size(j - 1), basis_size(d - 1), j + 1, d + 1).squaredNorm();
  }
}

/// Walks down from roots: what is kept of each part, and the noise that is left on each triangle.
class Filter {
 public:
  Filter(const ReflectedMesh& mesh, const NoisyForest& noisy, double rays)
      : mesh_(mesh), noisy_(noisy), rays_(rays), noise_(at(mesh.forest.count())) {}

  /// Triangle → ∫ of the square of what is left of noise.
  const std::vector<double>& noise() const { return noise_; }

  /// Of the polynomials of a degree on a root.
  double at_root(int root, int degree) {
    const auto part = noisy_.field.of(root).middleRows(basis_size(degree - 1), degree + 1);
    const double noise = noisy_.noise[at(root)][at(degree)];
    const double square = mesh_.forest.area(root) * part.square().sum();
    const Kept kept = degree == 0 ? Kept{1, noise / rays_} : kept_of(square, noise, rays_);
    noise_[at(root)] += kept.noise;
    return kept.share;
  }

  /// Of what halves add.
  double at_halves(int whole) {
    const int first = mesh_.forest.first_half(whole);
    const double noise = sum_of(noisy_.noise[at(first)]) + sum_of(noisy_.noise[at(first + 1)]) -
                         sum_of(noisy_.noise[at(whole)]);
    const Kept kept = kept_of(noisy_.added[at(whole)], std::max(noise, 0.), rays_);
    for (int h = 0; h < 2; ++h) noise_[at(first + h)] = 0.5 * (noise_[at(whole)] + kept.noise);
    return kept.share;
  }

 private:
  const ReflectedMesh& mesh_;
  const NoisyForest& noisy_;
  double rays_;
  std::vector<double> noise_;
};

/// The polynomial of a whole on one of its halves, projected to the half's order.
ChannelArray on_half(const ReflectedMesh& mesh, const ElementField& field, int whole, int half) {
  const auto& restriction =
      restriction_to_half(field.order[at(whole)], mesh.forest.cut(whole), half);
  const int size = basis_size(field.order[at(mesh.forest.first_half(whole) + half)]);
  return (restriction.topRows(size) * field.of(whole).matrix()).array();
}

std::array<ChannelArray, 2> added_by_halves(const ReflectedMesh& mesh, const ElementField& field,
                                            int whole) {
  const int first = mesh.forest.first_half(whole);
  return {field.of(first) - on_half(mesh, field, whole, 0),
          field.of(first + 1) - on_half(mesh, field, whole, 1)};
}

/// The noise that would be left with `rays` times as many of them, over all elements, weighted.
double noise_left(const ReflectedMesh& mesh, const NoisyForest& noisy,
                  const std::vector<double>& weight, double rays) {
  const TriangleForest& forest = mesh.forest;
  Filter filter(mesh, noisy, rays);
  for (int t = 0; t < forest.count(); ++t) {
    if (t < forest.root_count())
      for (int d = 0; d <= noisy.field.order[at(t)]; ++d) filter.at_root(t, d);
    if (!forest.is_leaf(t)) filter.at_halves(t);
  }
  double sum = 0;
  for (int e = 0; e < mesh.count(); ++e)
    sum += weight[at(e)] * filter.noise()[at(mesh.triangle[at(e)])];
  return sum;
}

}  // namespace

NoisyForest noisy_forest(const ReflectedMesh& mesh, const ElementField& field,
                         const FieldNoise& noise) {
  const TriangleForest& forest = mesh.forest;
  std::vector<int> order(mesh.order);
  // Halves come after their whole.
  for (int t = forest.count() - 1; t >= 0; --t)
    if (!forest.is_leaf(t)) {
      const std::size_t first = at(forest.first_half(t));
      order[at(t)] = std::max(order[first], order[first + 1]);
    }
  NoisyForest noisy{forest_field(mesh, field, std::move(order)), FieldNoise(at(forest.count())),
                    std::vector<double>(at(forest.count()))};
  for (int t = forest.count() - 1; t >= 0; --t) {
    if (forest.is_leaf(t)) {
      noisy.noise[at(t)] = noise[at(mesh.element[at(t)])];
      continue;
    }
    const std::array<ChannelArray, 2> more = added_by_halves(mesh, noisy.field, t);
    for (int h = 0; h < 2; ++h) {
      const int half = forest.first_half(t) + h;
      noisy.added[at(t)] += forest.area(half) * more[at(h)].square().sum();
      add_to_whole(restriction_to_half(noisy.field.order[at(t)], forest.cut(t), h),
                   noisy.field.order[at(half)], noisy.noise[at(half)], noisy.noise[at(t)]);
    }
  }
  return noisy;
}

QuietField without_noise(const ReflectedMesh& mesh, const NoisyForest& noisy,
                         const std::vector<double>& weight) {
  const TriangleForest& forest = mesh.forest;
  Filter filter(mesh, noisy, 1);
  ElementField quiet = noisy.field;
  for (int t = 0; t < forest.count(); ++t) {
    if (t < forest.root_count())
      for (int d = 0; d <= quiet.order[at(t)]; ++d)
        quiet.of(t).middleRows(basis_size(d - 1), d + 1) *= filter.at_root(t, d);
    if (forest.is_leaf(t)) continue;
    const std::array<ChannelArray, 2> more = added_by_halves(mesh, noisy.field, t);
    const double share = filter.at_halves(t);
    for (int h = 0; h < 2; ++h)
      quiet.of(forest.first_half(t) + h) = on_half(mesh, quiet, t, h) + share * more[at(h)];
  }
  QuietField result{zero_field(mesh), {}};
  for (int e = 0; e < mesh.count(); ++e) {
    result.field.of(e) = quiet.of(mesh.triangle[at(e)]);
    result.noise.push_back(weight[at(e)] * filter.noise()[at(mesh.triangle[at(e)])]);
  }
  return result;
}

double rays_for(const ReflectedMesh& mesh, const NoisyForest& noisy,
                const std::vector<double>& weight, double wanted) {
  constexpr double step = 1.125, most = 1e4;
  double rays = 1;
  while (rays < most && noise_left(mesh, noisy, weight, rays) > wanted) rays *= step;
  return rays;
}

}  // namespace halfshade
