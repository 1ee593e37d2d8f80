#include "meshing/discontinuity/search_budget.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

// Measured, in units of 1 to 2 µs: a line that is cast; what is seen from a point; how much more
// that is behind each face and each edge.
constexpr double of_swath = 0.5, of_piece = 1, of_step = 0.01, of_look = 1, of_turn = 0.015,
                 of_exact_turn = 1.5, of_face_behind = 0.06, of_edge_behind = 2e-4;
// For the jumps of a curve.
constexpr std::size_t looks_for_jumps = 6;
// So many jobs tell what all take, and one may take so many times its share of what is left.
constexpr std::size_t sample_size = 16;
constexpr double most_of_share = 1.2;

}  // namespace

double work_of(const SightEffort& effort) {
  return of_look * static_cast<double>(effort.looks) + of_turn * static_cast<double>(effort.turns) +
         of_exact_turn * static_cast<double>(effort.exact_turns);
}

double look_work(const TraceCounts& counts, std::size_t edges) {
  if (counts.effort.looks > 0)
    return work_of(counts.effort) / static_cast<double>(counts.effort.looks);
  const double depth =
      counts.pieces > 0 ? static_cast<double>(counts.crossings) / static_cast<double>(counts.pieces)
                        : 1;
  return of_look + of_face_behind * depth * depth +
         of_edge_behind * depth * static_cast<double>(edges);
}

std::vector<std::size_t> spread_jobs(std::size_t count, std::size_t most) {
  std::vector<std::size_t> jobs(std::min(count, most));
  std::iota(jobs.begin(), jobs.end(), 0);
  if (count <= most) return jobs;
  for (std::size_t& job : jobs) {
    const double turns = std::numbers::phi * static_cast<double>(job);
    job = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(count));
  }
  std::sort(jobs.begin(), jobs.end());
  jobs.erase(std::unique(jobs.begin(), jobs.end()), jobs.end());
  return jobs;
}

double SearchBudget::work_of(const TraceCounts& counts, std::size_t curves) const {
  return of_swath * static_cast<double>(counts.swaths) +
         of_step * static_cast<double>(counts.steps) +
         of_piece * static_cast<double>(counts.pieces) + halfshade::work_of(counts.effort) +
         look_work(counts, edges_) * static_cast<double>(looks_for_jumps * curves);
}

bool SearchBudget::allows(CurveKind kind, double work) {
  if (!(used_ + work > most_)) return true;
  left_out_[static_cast<std::size_t>(kind)] += work;
  return false;
}

std::vector<std::size_t> SearchBudget::sample(std::size_t count) const {
  return is_limited() ? spread_jobs(count, sample_size) : std::vector<std::size_t>();
}

double SearchBudget::most_for_one(std::size_t count) const {
  const double share =
      std::max(most_of_share / static_cast<double>(std::max<std::size_t>(count, 1)),
               0.03 / static_cast<double>(sample_size));
  return std::max(share * (most_ - used_), 1.);
}

}  // namespace halfshade
