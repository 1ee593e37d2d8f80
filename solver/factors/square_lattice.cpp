#include "solver/factors/square_lattice.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::size_t sizes = 7;
constexpr int fewest = 16;

/// Of some 10⁶ generators and shifts tried, what makes the mean of the logarithm of errors least
/// over sizes 16 to 512, for 240 kinks, straight and parabolic ones, and exponentials in all
/// directions: two thirds of those of Fibonacci lattices of as many points, and half of them with
/// many.
constexpr int generator = 295;
const Vec2 shift(0.0502, 0.5814);

/// 0 → 1 → 0 over a period.
double folded(double x) { return 1 - std::abs(2 * (x - std::floor(x)) - 1); }

SquareLattice::Watch watch(const Vec2& place, const std::vector<Vec2>& places, int except) {
  constexpr std::size_t count = SquareLattice::Watch::count;
  std::vector<std::pair<double, int>> near;
  for (int k = 0; k < static_cast<int>(places.size()); ++k)
    if (k != except) near.emplace_back((places[at(k)] - place).squaredNorm(), k);
  std::partial_sort(near.begin(), near.begin() + count, near.end());
  Eigen::Matrix<double, count, 3> line;
  for (std::size_t k = 0; k < count; ++k)
    line.row(static_cast<Eigen::Index>(k)) << 1, (places[at(near[k].second)] - place).transpose();
  const Eigen::Matrix<double, 3, count> fit =
      (line.transpose() * line).ldlt().solve(line.transpose());
  SquareLattice::Watch result;
  for (std::size_t k = 0; k < count; ++k) {
    result.near[k] = near[k].second;
    result.weight[k] = fit(0, static_cast<Eigen::Index>(k));
  }
  return result;
}

/// The digits of k in base two, mirrored at the point: 0, 1/2, 1/4, 3/4, 1/8, ...
double mirrored(int k) {
  double sum = 0;
  for (double digit = 0.5; k > 0; k /= 2, digit *= 0.5) sum += k % 2 * digit;
  return sum;
}

SquareLattice square_lattice(int count) {
  SquareLattice lattice;
  for (int k = 0; k < count; ++k) {
    const double x = mirrored(k);
    lattice.places.emplace_back(folded(x + shift.x()), folded(generator * x + shift.y()));
  }
  for (int k = 0; k < count; ++k)
    lattice.inner.push_back(watch(lattice.places[at(k)], lattice.places, k));
  for (std::size_t k = 0; k < 4; ++k)
    lattice.corners[k] = watch(lattice.corner(k), lattice.places, -1);
  return lattice;
}

}  // namespace

std::span<const SquareLattice> square_lattices() {
  static const std::array<SquareLattice, sizes> lattices = [] {
    std::array<SquareLattice, sizes> all;
    for (std::size_t k = 0; k < sizes; ++k) all[k] = square_lattice(fewest << k);
    return all;
  }();
  return lattices;
}

}  // namespace halfshade
