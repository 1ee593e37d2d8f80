#include "solver/reflected/lockstep_gmres.h"

#include "meshing/core/types.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr int restart = 60;
/// Where a cycle leaves more than this of the residual, more of them do not help.
constexpr double stagnant = 0.9;
/// A new direction that is shorter than this share of what it was made from is rounding.
constexpr double exhausted = 1e-14;

/// y += factor · x, a factor for each vector.
void add_scaled(const RowGroups& groups, const ChannelArray& factor, const ChannelArray& x,
                ChannelArray& y) {
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    y.row(i) += factor.row(groups.of_row[static_cast<std::size_t>(i)]) * x.row(i);
}

ChannelArray scaled(const RowGroups& groups, const ChannelArray& factor, ChannelArray x) {
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x.row(i) *= factor.row(groups.of_row[static_cast<std::size_t>(i)]);
  return x;
}

ChannelArray inverse_or_zero(const ChannelArray& length, const ChannelArray& least) {
  return (length > least).select(1 / length, ChannelArray::Zero(length.rows(), 3));
}

/// The small least-squares problem of one system, kept triangular by rotations.
struct Projected {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(restart + 1, restart);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(restart + 1);
  Eigen::VectorXd cosine = Eigen::VectorXd::Zero(restart), sine = cosine;

  void add_column(int k) {
    for (int i = 0; i < k; ++i) rotate(i, R(i, k), R(i + 1, k));
    const double length = std::hypot(R(k, k), R(k + 1, k));
    cosine[k] = length > 0 ? R(k, k) / length : 1;
    sine[k] = length > 0 ? R(k + 1, k) / length : 0;
    rotate(k, R(k, k), R(k + 1, k));
    rotate(k, g[k], g[k + 1]);
  }
  Eigen::VectorXd solution(int n) const {
    Eigen::VectorXd y = g.head(n);
    for (int i = n - 1; i >= 0; --i) {
      for (int j = i + 1; j < n; ++j) y[i] -= R(i, j) * y[j];
      y[i] = R(i, i) != 0 ? y[i] / R(i, i) : 0;
    }
    return y;
  }
  double amplification(int n) const {
    int rank = 0;
    while (rank < n && R(rank, rank) != 0) ++rank;
    if (rank == 0) return 1;
    const Eigen::VectorXd values =
        Eigen::JacobiSVD<Eigen::MatrixXd>(R.topLeftCorner(rank, rank)).singularValues();
    return 1 / values[rank - 1];
  }

 private:
  void rotate(int i, double& a, double& b) const {
    const double up = cosine[i] * a + sine[i] * b;
    b = cosine[i] * b - sine[i] * a;
    a = up;
  }
};

/// One run of steps from one residual for all systems.
class Cycle {
 public:
  Cycle(const RowGroups& groups, const ChannelArray& residual)
      : groups_(groups), small_(3 * at(groups.count)) {
    const ChannelArray length = dots(groups, residual, residual).sqrt();
    basis_.push_back(
        scaled(groups, inverse_or_zero(length, ChannelArray::Zero(groups.count, 3)), residual));
    for_each([&](int s, int c, Projected& p) { p.g[0] = length(s, c); });
  }

  const ChannelArray& last() const { return basis_.back(); }
  int steps() const { return steps_; }

  void add(ChannelArray image) {
    const int k = steps_++;
    const ChannelArray whole = dots(groups_, image, image).sqrt();
    for (int i = 0; i <= k; ++i) {
      const ChannelArray along = dots(groups_, basis_[at(i)], image);
      add_scaled(groups_, -along, basis_[at(i)], image);
      for_each([&](int s, int c, Projected& p) { p.R(i, k) = along(s, c); });
    }
    const ChannelArray length = dots(groups_, image, image).sqrt(), least = exhausted * whole;
    basis_.push_back(scaled(groups_, inverse_or_zero(length, least), std::move(image)));
    for_each([&](int s, int c, Projected& p) {
      p.R(k + 1, k) = length(s, c) > least(s, c) ? length(s, c) : 0;
      p.add_column(k);
    });
  }

  ChannelArray residual() {
    ChannelArray result(groups_.count, 3);
    for_each([&](int s, int c, Projected& p) { result(s, c) = std::abs(p.g[steps_]); });
    return result;
  }

  void add_solution(ChannelArray& x) {
    std::vector<ChannelArray> factors(at(steps_), ChannelArray(groups_.count, 3));
    for_each([&](int s, int c, Projected& p) {
      const Eigen::VectorXd y = p.solution(steps_);
      for (int k = 0; k < steps_; ++k) factors[at(k)](s, c) = y[k];
    });
    for (int k = 0; k < steps_; ++k) add_scaled(groups_, factors[at(k)], basis_[at(k)], x);
  }

  double amplification() {
    double most = 1;
    for_each([&](int, int, Projected& p) { most = std::max(most, p.amplification(steps_)); });
    return most;
  }

 private:
  template <class Use>
  void for_each(const Use& use) {
    for (int s = 0; s < groups_.count; ++s)
      for (int c = 0; c < 3; ++c) use(s, c, small_[at(3 * s + c)]);
  }

  const RowGroups& groups_;
  std::vector<ChannelArray> basis_;
  std::vector<Projected> small_;
  int steps_ = 0;
};

}  // namespace

ChannelArray dots(const RowGroups& groups, const ChannelArray& a, const ChannelArray& b) {
  ChannelArray sums = ChannelArray::Zero(groups.count, 3);
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    sums.row(groups.of_row[static_cast<std::size_t>(i)]) += groups.weight[i] * a.row(i) * b.row(i);
  return sums;
}

GmresResult gmres(const std::function<ChannelArray(const ChannelArray&)>& A, const ChannelArray& b,
                  const RowGroups& groups, double tolerance, int max_iterations) {
  GmresResult result;
  result.x = ChannelArray::Zero(b.rows(), 3);
  const ChannelArray size = dots(groups, b, b).sqrt();
  const ChannelArray inverse = inverse_or_zero(size, ChannelArray::Zero(groups.count, 3));
  ChannelArray residual = b;
  double last = 2;
  while (result.iterations < max_iterations && (size > 0).any()) {
    Cycle cycle(groups, residual);
    do {
      cycle.add(A(cycle.last()));
      result.residual = (cycle.residual() * inverse).maxCoeff();
      ++result.iterations;
    } while (cycle.steps() < restart && result.residual > tolerance &&
             result.iterations < max_iterations);
    cycle.add_solution(result.x);
    result.amplification = std::max(result.amplification, cycle.amplification());
    if (result.residual <= tolerance || result.residual > stagnant * last) break;
    last = result.residual;
    residual = b - A(result.x);
  }
  return result;
}

}  // namespace halfshade
