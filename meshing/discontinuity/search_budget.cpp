#include "meshing/discontinuity/search_budget.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Measured, in units of 1 to 2 µs: a line that is cast, and how much it adds to the work that
// one of its faces comes with; what is seen from a point.
constexpr double of_swath = 0.5, of_piece = 1, of_step = 0.01, of_face_behind = 0.06,
                 of_edge_behind = 2e-4;
// For a piece that is decided, and for a curve's jumps: three and six visible parts, each at a
// place where edges line up, so that signs take exact arithmetic.
constexpr std::size_t looks_to_decide = 12, looks_for_jumps = 24;
// So many jobs tell what all take, and one may take so many times its share of what is left.
constexpr std::size_t sample_size = 16;
constexpr double most_of_share = 1.2;

}  // namespace

double look_work(const TraceCounts& counts, std::size_t edges) {
  const double depth =
      counts.pieces > 0 ? static_cast<double>(counts.crossings) / static_cast<double>(counts.pieces)
                        : 1;
  return 1 + of_face_behind * depth * depth + of_edge_behind * depth * static_cast<double>(edges);
}

double SearchBudget::work_of(const TraceCounts& counts, std::size_t curves) const {
  const auto looks =
      static_cast<double>(looks_to_decide * counts.decisions + looks_for_jumps * curves);
  return of_swath * static_cast<double>(counts.swaths) +
         of_step * static_cast<double>(counts.steps) +
         of_piece * static_cast<double>(counts.pieces) + look_work(counts, edges_) * looks;
}

bool SearchBudget::allows(CurveKind kind, double work) {
  if (!(used_ + work > most_)) return true;
  left_out_[static_cast<std::size_t>(kind)] += work;
  return false;
}

std::vector<std::size_t> SearchBudget::sample(std::size_t count) const {
  std::vector<std::size_t> jobs;
  if (is_limited())
    for (std::size_t k = 0; k < std::min(sample_size, count); ++k)
      jobs.push_back(k * count / std::min(sample_size, count));
  return jobs;
}

double SearchBudget::most_for_one(std::size_t count) const {
  const double share =
      std::max(most_of_share / static_cast<double>(std::max<std::size_t>(count, 1)),
               0.03 / static_cast<double>(sample_size));
  return std::max(share * (most_ - used_), 1.);
}

}  // namespace halfshade
