#include "solver/reflected/lockstep_gmres.h"

#include "meshing/core/types.h"
#include "solver/elements/balancing_scale.h"

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

/// Powers of two that bring the largest of each vector to about 1: systems may differ by so much
/// that squares of one of them vanish.
ChannelArray balancing_scales(const RowGroups& groups, const ChannelArray& x) {
  ChannelArray most = ChannelArray::Zero(groups.count, 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    auto of_group = most.row(groups.of_row[static_cast<std::size_t>(i)]);
    of_group = of_group.max(x.row(i).abs());
  }
  return most.unaryExpr([](double largest) { return balancing_scale(largest); });
}

/// The small least-squares problem of one system, kept triangular by rotations.
class Projected {
 public:
  void begin(double length, double enough) {
    g_ = {length};
    is_done_ = length <= enough;
  }
  /// The residual is small enough. More steps would only see rounding, and tell nonsense of the
  /// system's singular values.
  bool is_done() const { return is_done_; }
  /// Of the residual.
  double left() const { return std::abs(g_.back()); }

  /// Products of the next image with all directions before it, and the length of what is left.
  void add_column(Eigen::VectorXd column, double enough) {
    if (is_done_) return;
    const int k = static_cast<int>(columns_.size());
    for (int i = 0; i < k; ++i) rotate(at(i), column[i], column[i + 1]);
    const double length = std::hypot(column[k], column[k + 1]);
    cosine_.push_back(length > 0 ? column[k] / length : 1);
    sine_.push_back(length > 0 ? column[k + 1] / length : 0);
    rotate(at(k), column[k], column[k + 1]);
    g_.push_back(0);
    rotate(at(k), g_[at(k)], g_[at(k + 1)]);
    columns_.push_back(std::move(column));
    is_done_ = left() <= enough;
  }

  /// Factors of the directions.
  Eigen::VectorXd solution() const {
    const int n = static_cast<int>(columns_.size());
    Eigen::VectorXd y(n);
    for (int i = n - 1; i >= 0; --i) {
      y[i] = g_[at(i)];
      for (int j = i + 1; j < n; ++j) y[i] -= columns_[at(j)][i] * y[j];
      y[i] = columns_[at(i)][i] != 0 ? y[i] / columns_[at(i)][i] : 0;
    }
    return y;
  }
  double amplification() const {
    const int count = static_cast<int>(columns_.size());
    int n = 0;  // rank
    while (n < count && columns_[at(n)][n] != 0) ++n;
    if (n == 0) return 1;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(n, n);
    for (int k = 0; k < n; ++k) R.col(k).head(k + 1) = columns_[at(k)].head(k + 1);
    return 1 / Eigen::JacobiSVD<Eigen::MatrixXd>(R).singularValues()[n - 1];
  }

 private:
  void rotate(std::size_t i, double& a, double& b) const {
    const double up = cosine_[i] * a + sine_[i] * b;
    b = cosine_[i] * b - sine_[i] * a;
    a = up;
  }

  std::vector<Eigen::VectorXd> columns_;  ///< each down to below its diagonal, where it is 0
  std::vector<double> g_, cosine_, sine_;
  bool is_done_ = false;
};

/// One run of steps from one residual for all systems, each until its residual is small enough.
class Cycle {
 public:
  Cycle(const RowGroups& groups, const ChannelArray& residual, const ChannelArray& enough)
      : groups_(groups), enough_(enough), small_(3 * at(groups.count)) {
    const ChannelArray length = dots(groups, residual, residual).sqrt();
    for_each([&](int s, int c, Projected& p) { p.begin(length(s, c), enough_(s, c)); });
    push(residual, length, ChannelArray::Zero(groups.count, 3));
  }

  const ChannelArray& last() const { return basis_.back(); }
  int steps() const { return static_cast<int>(basis_.size()) - 1; }

  void add(ChannelArray image) {
    const int k = steps();
    const ChannelArray whole = dots(groups_, image, image).sqrt();
    std::vector<Eigen::VectorXd> columns(small_.size());
    for_each([&](int s, int c, Projected& p) {
      if (!p.is_done()) columns[at(3 * s + c)].setZero(k + 2);
    });
    const auto put = [&](int i, const ChannelArray& values) {
      for_each([&](int s, int c, Projected& p) {
        if (!p.is_done()) columns[at(3 * s + c)][i] += values(s, c);
      });
    };
    // What is left once may be nearly all rounding, which lies along the others again.
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i <= k; ++i) {
        const ChannelArray along = dots(groups_, basis_[at(i)], image);
        add_scaled(groups_, -along, basis_[at(i)], image);
        put(i, along);
      }
    const ChannelArray length = dots(groups_, image, image).sqrt(), least = exhausted * whole;
    put(k + 1, (length > least).select(length, 0.));
    for_each([&](int s, int c, Projected& p) {
      p.add_column(std::move(columns[at(3 * s + c)]), enough_(s, c));
    });
    push(std::move(image), length, least);
  }

  ChannelArray residual() {
    ChannelArray result(groups_.count, 3);
    for_each([&](int s, int c, const Projected& p) { result(s, c) = p.left(); });
    return result;
  }

  void add_solution(ChannelArray& x) {
    std::vector<ChannelArray> factors(at(steps()), ChannelArray::Zero(groups_.count, 3));
    for_each([&](int s, int c, const Projected& p) {
      const Eigen::VectorXd y = p.solution();
      for (int k = 0; k < y.size(); ++k) factors[at(k)](s, c) = y[k];
    });
    for (int k = 0; k < steps(); ++k) add_scaled(groups_, factors[at(k)], basis_[at(k)], x);
  }

  double amplification() {
    double most = 1;
    for_each([&](int, int, const Projected& p) { most = std::max(most, p.amplification()); });
    return most;
  }

 private:
  /// Of unit length; 0 for systems that are done or exhausted.
  void push(ChannelArray direction, const ChannelArray& length, const ChannelArray& least) {
    ChannelArray inverse = inverse_or_zero(length, least);
    for_each([&](int s, int c, const Projected& p) {
      if (p.is_done()) inverse(s, c) = 0;
    });
    basis_.push_back(scaled(groups_, inverse, std::move(direction)));
  }

  template <class Use>
  void for_each(const Use& use) {
    for (int s = 0; s < groups_.count; ++s)
      for (int c = 0; c < 3; ++c) use(s, c, small_[at(3 * s + c)]);
  }

  const RowGroups& groups_;
  const ChannelArray& enough_;
  std::vector<ChannelArray> basis_;
  std::vector<Projected> small_;
};

}  // namespace

ChannelArray dots(const RowGroups& groups, const ChannelArray& a, const ChannelArray& b) {
  ChannelArray sums = ChannelArray::Zero(groups.count, 3);
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    sums.row(groups.of_row[static_cast<std::size_t>(i)]) += groups.weight[i] * a.row(i) * b.row(i);
  return sums;
}

GmresResult gmres(const std::function<ChannelArray(const ChannelArray&)>& A,
                  const ChannelArray& right_side, const RowGroups& groups, double tolerance,
                  int max_iterations, const std::function<bool()>& stopped) {
  GmresResult result;
  const auto is_stopped = [&] { return stopped && stopped(); };
  result.x = ChannelArray::Zero(right_side.rows(), 3);
  if (!right_side.allFinite()) {
    result.residual = HUGE_VAL;
    return result;
  }
  const ChannelArray scale = balancing_scales(groups, right_side);
  const ChannelArray b = scaled(groups, scale, right_side);
  const ChannelArray size = dots(groups, b, b).sqrt();
  const ChannelArray inverse = inverse_or_zero(size, ChannelArray::Zero(groups.count, 3));
  const ChannelArray enough = tolerance * size;
  ChannelArray residual = b;
  double last = 2;
  while (result.iterations < max_iterations && (size > 0).any()) {
    Cycle cycle(groups, residual, enough);
    do {
      cycle.add(A(cycle.last()));
      result.residual = (cycle.residual() * inverse).maxCoeff();
      ++result.iterations;
    } while (cycle.steps() < restart && result.residual > tolerance &&
             result.iterations < max_iterations && !is_stopped());
    cycle.add_solution(result.x);
    result.amplification = std::max(result.amplification, cycle.amplification());
    if (result.residual <= tolerance || result.residual > stagnant * last || is_stopped()) break;
    last = result.residual;
    residual = b - A(result.x);
  }
  result.x = scaled(groups, 1 / scale, std::move(result.x));
  return result;
}

}  // namespace halfshade
