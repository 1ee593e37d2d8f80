#include "solver/factors/surface_exchange.h"

#include "solver/factors/exact_pairs.h"
#include "solver/factors/row_sums.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rows that do not sum to one are looked at again, with so much of what their pairs may be off by,
/// at most so often.
constexpr double share_again = 0.1;
constexpr int most_times_again = 3;
/// But for those whose sums were off by as much before, but for this share: what is found ten times
/// as exactly does not stay as it was. Where walls do not quite meet rows leak.
constexpr double hardly_changed = 0.05;

/// Rows whose sums tell that an entry is off by more than it claims, and so far that it matters.
std::vector<bool> refuted_rows(const RowSums& sums, double tolerance) {
  std::vector<bool> rows;
  for (Eigen::Index i = 0; i < sums.area.size(); ++i) {
    const double missing = sums.missing[i] / sums.area[i];
    rows.push_back(missing > tolerance || (missing > tolerance / 2 && sums.is_refuted(i)));
  }
  return rows;
}

}  // namespace

void RowExchange::add(int row, int other, double value, double error) {
  if (other < 0) {
    space[row] += value;
    space_error[row] += error;
    if (other == unused_back) backs[row] += value;
    return;
  }
  // A pair within a row is seen from both sides.
  mutual(row, other) += row == other ? 2 * value : value;
  mutual(other, row) = mutual(row, other);
  mutual_error(row, other) += row == other ? 2 * error : error;
  mutual_error(other, row) = mutual_error(row, other);
}

void RowExchange::add(int row, int other, Sight sight, const MutualSight& seen) {
  add(row, other, seen.value, seen.error);
  (sight == Sight::clear ? report.clear_pairs : report.partial_pairs) += 1;
  report.points += seen.points;
  report.pairs_at_limit += seen.is_at_limit ? 1 : 0;
}

RowExchange exact_exchange(const FactorScene& scene, const SightScene& sight,
                           const FactorOptions& options, const Progress& progress) {
  ExactPairs pairs(scene, sight, options, progress);
  RowExchange exchange(0);
  exchange.report.is_complete = false;
  // Of many rows it takes a while to add up what nobody asks for any more.
  if (!pairs.see_clear() || !pairs.see_partial()) return exchange;
  exchange = pairs.exchange();
  double share = share_again;
  Eigen::ArrayXd before;
  std::vector<bool> asked;
  for (int times = 0; times < most_times_again; ++times, share *= share_again) {
    const RowSums sums(scene, exchange);
    std::vector<bool> rows = refuted_rows(sums, options.tolerance);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double change = std::abs(sums.missing[row] - before[row]);
      if (asked[i] && change < hardly_changed * before[row]) rows[i] = false;
    }
    asked = rows;
    before = sums.missing;
    if (std::find(rows.begin(), rows.end(), true) == rows.end()) break;
    exchange.report.is_complete = pairs.see_again(rows, share);
    if (!exchange.report.is_complete) break;
    exchange = pairs.exchange();
  }
  return exchange;
}

}  // namespace halfshade
