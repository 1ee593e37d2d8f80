#pragma once

#include "meshing/discontinuity/swath_tracer.h"
#include "meshing/events/critical_event.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace halfshade {

/// Work that looks took.
double work_of(const SightEffort& effort);

/// Work that it takes to see what a point sees of an emitter: the mean of the looks that there
/// were. Before any it grows with how many faces lie behind each other, of which the lines that
/// were traced tell, and with the edges among them.
double look_work(const TraceCounts& counts, std::size_t edges);

/// Some of `count` jobs, `most` at most, or all if these are enough: spread evenly, but with no
/// period, for so have the edges of many boxes. Ascending.
std::vector<std::size_t> spread_jobs(std::size_t count, std::size_t most);

/// Says which kinds of curves one source's share of the work affords. Counts instead of times, so
/// that the answer is always the same.
class SearchBudget {
 public:
  static constexpr double of_test =
      0.005;  ///< whether an edge and a vertex can line up, or a point limits a view
  static constexpr double of_pair = 0.03;  ///< whether two edges can
  static constexpr double of_swath = 0.1;  ///< making one, not yet traced

  /// HUGE_VAL: no limit.
  SearchBudget(double most, std::size_t edges) : most_(most), edges_(edges) {}

  /// Whether so much work is left; notes what is left out if not.
  bool allows(CurveKind kind, double work);
  void use(double work) { used_ += work; }
  bool is_limited() const { return std::isfinite(most_); }

  /// Work that was done by tracing, and that the jumps of the curves found will take.
  double work_of(const TraceCounts& counts, std::size_t curves) const;

  /// Jobs that tell what all take; none if there is no need to know.
  std::vector<std::size_t> sample(std::size_t count) const;
  /// Work on one of the sample that is enough to know that all take too much; above 0.
  double most_for_one(std::size_t count) const;

  double used() const { return used_; }
  const std::array<double, curve_kinds>& left_out() const { return left_out_; }

 private:
  double most_, used_ = 0;
  std::size_t edges_;  ///< that can be silhouettes
  std::array<double, curve_kinds> left_out_{};
};

}  // namespace halfshade
