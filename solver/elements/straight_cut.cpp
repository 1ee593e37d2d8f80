#include "solver/elements/straight_cut.h"

#include "solver/elements/balancing_scale.h"
#include "solver/elements/straight_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

struct Cut {
  std::vector<int> along_edge;
  long long pieces = 0;
  double square = 0;  ///< of the error in the L2 norm
};

/// Finds cuts by what each piece may add to the square of the error.
class Cutter {
 public:
  Cutter(const ElementField& field, std::span<const double> areas, int most_pieces, double scale)
      : error_(field, scale),
        areas_(areas),
        most_pieces_(std::max(most_pieces, field.count())),
        most_along_edge_(static_cast<int>(std::sqrt(most_pieces_))) {}

  double mean_square(int element, int along_edge) {
    return error_.mean_square(element, along_edge);
  }

  /// Of elements that are not cut, the most.
  double largest() {
    double most = 0;
    for (int e = 0; e < error_.count(); ++e) most = std::max(most, square(e, 1));
    return most;
  }

  /// So that each piece adds `most` at most.
  Cut cut(double most) {
    Cut found;
    for (int e = 0; e < error_.count(); ++e) {
      const int n = fewest(e, most);
      found.along_edge.push_back(n);
      found.pieces += static_cast<long long>(n) * n;
      found.square += square(e, n);
    }
    return found;
  }

  bool is_too_much(const Cut& cut) const { return cut.pieces > most_pieces_; }

 private:
  double square(int element, int along_edge) {
    return areas_[at(element)] * mean_square(element, along_edge);
  }

  bool is_enough(int element, int n, double most) { return square(element, n) <= most * n * n; }

  int fewest(int element, double most) {
    if (is_enough(element, 1, most)) return 1;
    int low = 1, high = 2;
    while (high <= most_along_edge_ && !is_enough(element, high, most)) low = high, high *= 2;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (is_enough(element, middle, most) ? high : low) = middle;
    }
    return high;
  }

  StraightError error_;
  std::span<const double> areas_;
  int most_pieces_, most_along_edge_;
};

/// The coarsest that is off by no more than the square, or the finest there may be.
Cut find_cut(Cutter& cutter, double most_square) {
  const auto is_fine = [&](const Cut& cut) {
    return cut.square <= most_square || cutter.is_too_much(cut);
  };
  double most = cutter.largest();
  Cut coarse = cutter.cut(most);
  if (most == 0 || is_fine(coarse)) return coarse;
  Cut fine = coarse;
  double step = 4;
  while (!is_fine(fine)) {
    coarse = std::move(fine);
    most /= step;
    fine = cutter.cut(most);
  }
  constexpr int halvings = 10;
  for (int k = 0; k < halvings; ++k) {
    step = std::sqrt(step);
    Cut middle = cutter.cut(most * step);
    if (is_fine(middle)) {
      fine = std::move(middle);
      most *= step;
    } else {
      coarse = std::move(middle);
    }
  }
  return cutter.is_too_much(fine) ? coarse : fine;
}

double square_sum(const ElementField& field, std::span<const double> areas, double scale) {
  double sum = 0;
  for (int e = 0; e < field.count(); ++e)
    sum += areas[at(e)] * (scale * field.of(e).matrix()).squaredNorm();
  return sum;
}

}  // namespace

long long StraightCut::pieces() const {
  long long sum = 0;
  for (const int n : along_edge) sum += static_cast<long long>(n) * n;
  return sum;
}

StraightCut straight_cut(const ElementField& field, std::span<const double> areas, double allowed,
                         int most_pieces) {
  StraightCut found;
  found.along_edge.assign(at(field.count()), 1);
  found.off = Eigen::ArrayXd::Zero(field.count());
  if (field.coefficients.rows() == 0) return found;
  const double scale = balancing_scale(field.coefficients.abs().maxCoeff());
  const double largest = *std::max_element(areas.begin(), areas.end());
  std::vector<double> shares(areas.begin(), areas.end());
  for (double& area : shares) area /= largest;
  const double norm = square_sum(field, shares, scale);
  const double most_square = allowed * allowed * norm;
  if (!(norm > 0) || !std::isfinite(norm)) return found;

  Cutter cutter(field, shares, most_pieces, scale);
  Cut cut = find_cut(cutter, most_square);
  found.along_edge = std::move(cut.along_edge);
  for (int e = 0; e < field.count(); ++e)
    found.off[e] = std::sqrt(cutter.mean_square(e, found.along_edge[at(e)])) / scale;
  found.relative_error = std::sqrt(cut.square / norm);
  found.is_limited = cut.square > most_square;
  return found;
}

}  // namespace halfshade
