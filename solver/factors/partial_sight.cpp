#include "solver/factors/blocked_cell.h"

#include <algorithm>
#include <optional>

namespace halfshade {
namespace {

/// Of what a pair may be off by: what the two without anything between them take little for, and
/// what is hidden, whose estimate is no bound to the letter.
constexpr double share_of_whole = 0.02, share_of_hidden = 0.5;

/// At how many points each of the two surfaces is tried before the better one is gone on with; and
/// again at so many times as many, for few points may tell wrong: what lies close before one of
/// them hides things in layers that it takes many to see.
constexpr std::size_t points_to_try = 150, more_points = 16;

/// An error that was not found at so many points is believed only if it is far smaller than what
/// is allowed: few points agree by chance. (In a furnished room one entry in a thousand was off by
/// up to ten times its error, at 20 points.)
constexpr std::size_t points_to_believe = 100;
constexpr double far_smaller = 1. / 16;

/// Errors this many times too large are worth looking for kinks, about 30 points each: without,
/// cells grow like the root of it.
constexpr double far_off = 20;

/// Errors of two sides that differ by less than this factor check each other.
constexpr double comparable = 4;

bool is_worse(const BlockedCell& a, const BlockedCell& b) { return a.error < b.error; }

struct Total {
  double value = 0, error = 0;
};

Total total_of(const std::vector<BlockedCell>& cells) {
  Total total;
  for (const BlockedCell& cell : cells) {
    total.value += cell.value;
    total.error += cell.error;
  }
  return total;
}

/// Cubature of what is hidden of one surface over the triangles of the other, the worst cell first.
class HiddenIntegral {
 public:
  HiddenIntegral(const SightScene& scene, PointLooks& looks, int a, int b,
                 const FacingTriangles& facing, const SightTolerance& tolerance,
                 const std::stop_token& stop)
      : evaluator_(scene, looks, a, b, tolerance, stop) {
    for (const Triangle3& triangle : facing.triangles) cells_.push_back(evaluator_.look(triangle));
    std::make_heap(cells_.begin(), cells_.end(), is_worse);
    total_ = total_of(cells_);
  }

  const Total& total() const { return total_; }
  std::size_t points() const { return evaluator_.points(); }

  void refine_worst(bool along_kinks) {
    std::pop_heap(cells_.begin(), cells_.end(), is_worse);
    const BlockedCell worst = cells_.back();
    cells_.pop_back();
    evaluator_.refine(worst, along_kinks, next_);
    total_.value -= worst.value;
    total_.error -= worst.error;
    for (const BlockedCell& cell : next_) {
      total_.value += cell.value;
      total_.error += cell.error;
      cells_.push_back(cell);
      std::push_heap(cells_.begin(), cells_.end(), is_worse);
    }
    // Sums of differences drift.
    if (cells_.size() >= next_sum_) {
      total_ = total_of(cells_);
      next_sum_ = 2 * cells_.size();
    }
  }

  void settle() { total_ = total_of(cells_); }

 private:
  BlockedCells evaluator_;
  std::vector<BlockedCell> cells_, next_;
  std::size_t next_sum_ = 64;
  Total total_;
};

/// Two surfaces without what is between them.
MutualSight unhidden(const SightScene& scene, int a, int b, const FacingTriangles& facing,
                     const SightTolerance& tolerance, const std::stop_token& stop) {
  if (facing.is_all) return clear_sight(scene, a, b, tolerance, stop);
  MutualSight sum;
  for (const Triangle3& triangle : facing.triangles) {
    const MutualSight part = clear_sight(scene, triangle, b, tolerance, stop);
    sum.value += part.value;
    sum.error += part.error;
    sum.is_reached = sum.is_reached && part.is_reached;
    sum.is_at_limit = sum.is_at_limit || part.is_at_limit;
  }
  return sum;
}

SightTolerance share_of(SightTolerance tolerance, double share) {
  tolerance.absolute *= share;
  tolerance.relative *= share;
  return tolerance;
}

/// One side of a pair: what it sees unhidden, and what of that is hidden.
struct OneSide {
  MutualSight whole;
  HiddenIntegral hidden;
  SightTolerance tolerance;

  OneSide(const SightScene& scene, PointLooks& looks, int a, int b, const SightTolerance& asked,
          const std::stop_token& stop)
      : OneSide(scene, looks, a, b, facing_triangles(scene, a, b), asked, stop) {}

  double value() const { return std::max(0., whole.value - hidden.total().value); }
  double error() const { return whole.error + hidden.total().error; }
  double allowed() const { return tolerance.allowed(value()); }
  bool is_reached() const { return hidden.total().error <= allowed(); }
  bool is_far_off() const { return hidden.total().error > far_off * allowed(); }
  bool is_believed() const {
    return hidden.points() >= points_to_believe || hidden.total().error <= far_smaller * allowed();
  }
  void refine_to(std::size_t points) {
    while (!(is_reached() && is_believed()) && hidden.points() < points && !stop_.stop_requested())
      hidden.refine_worst(is_far_off());
    hidden.settle();
  }

 private:
  OneSide(const SightScene& scene, PointLooks& looks, int a, int b, const FacingTriangles& facing,
          const SightTolerance& asked, const std::stop_token& stop)
      : whole(unhidden(scene, a, b, facing, share_of(asked, share_of_whole), stop)),
        hidden(scene, looks, a, b, facing, asked, stop),
        tolerance(share_of(asked, share_of_hidden)),
        stop_(stop) {}

  const std::stop_token& stop_;
};

/// A pair from the one side, and if few points do not suffice from the other, too.
class BothSides {
 public:
  BothSides(const SightScene& scene, PointLooks& looks, int a, int b,
            const SightTolerance& tolerance, const std::stop_token& stop)
      : is_trial_(tolerance.is_trial),
        most_(static_cast<std::size_t>(tolerance.max_points)),
        stop_(stop),
        first_(scene, looks, a, b, tolerance, stop) {
    first_.refine_to(std::min(points_to_try, most_));
    if (first_.is_reached()) return;
    second_.emplace(scene, looks, b, a, tolerance, stop);
    second_->refine_to(std::min(points_to_try, most_));
  }

  MutualSight see() {
    if (second_ && !is_trial_) race();
    const OneSide& best = better();
    MutualSight result = best.whole;
    result.is_reached = result.is_reached && best.is_reached();
    result.is_at_limit =
        result.is_at_limit || (!best.is_reached() && best.hidden.points() >= most_);
    result.value = best.value();
    result.error = std::max(best.error(), contradiction());
    result.points = first_.hidden.points() + (second_ ? second_->hidden.points() : 0);
    return result;
  }

 private:
  bool is_second_better() const { return second_ && second_->error() < first_.error(); }
  OneSide& better() { return is_second_better() ? *second_ : first_; }
  OneSide& other() { return is_second_better() ? first_ : *second_; }

  /// The one that seems better first and, unless it is nearly there, the other: with more points
  /// each time.
  void race() {
    std::size_t points = std::min(points_to_try, most_);
    while (!first_.is_reached() && !second_->is_reached() && points < most_ &&
           !stop_.stop_requested()) {
      points = std::min(points * more_points, most_);
      OneSide &front = better(), &back = other();
      front.refine_to(points);
      if (front.is_far_off() && points < most_) back.refine_to(points);
    }
  }

  /// Where both sides claim to be about as exact, what they say must not differ by more.
  double contradiction() {
    if (!second_ || !(other().error() < comparable * better().error())) return 0;
    return std::abs(other().value() - better().value()) - other().error();
  }

  bool is_trial_;
  std::size_t most_;
  const std::stop_token& stop_;
  OneSide first_;
  std::optional<OneSide> second_;
};

}  // namespace

MutualSight partial_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance,
                          const std::stop_token& stop) {
  PointLooks looks(scene);
  return partial_sight(scene, looks, a, b, tolerance, stop);
}

MutualSight partial_sight(const SightScene& scene, PointLooks& looks, int a, int b,
                          const SightTolerance& tolerance, const std::stop_token& stop) {
  return BothSides(scene, looks, a, b, tolerance, stop).see();
}

}  // namespace halfshade
