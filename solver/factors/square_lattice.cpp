#include "solver/factors/square_lattice.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::array<int, 9> fibonacci = {13, 21, 34, 55, 89, 144, 233, 377, 610};
constexpr std::size_t sizes = 8;

/// Of a step: folded, points lie evenly along either side, then.
constexpr double shift = 0.25;

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

SquareLattice square_lattice(int step, int count) {
  SquareLattice lattice;
  for (int k = 0; k < count; ++k)
    lattice.places.emplace_back(folded((k + shift) / count),
                                folded((static_cast<double>(k) * step + shift) / count));
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
    for (std::size_t k = 0; k < sizes; ++k) all[k] = square_lattice(fibonacci[k], fibonacci[k + 1]);
    return all;
  }();
  return lattices;
}

}  // namespace halfshade
