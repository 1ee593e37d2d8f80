#include "solver/factors/surface_exchange.h"

#include "meshing/core/parallel.h"
#include "solver/factors/error_shares.h"
#include "solver/factors/lattice_sight.h"
#include "solver/factors/pair_search.h"
#include "solver/factors/row_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace halfshade {
namespace {

/// So few clear pairs are found to rounding in half a second, and are then, whatever is asked for:
/// what rules say that they are off by is far more than they are. None takes more points for that.
constexpr std::size_t few_clear_pairs = 10000;
constexpr int points_to_rounding = 5000;
constexpr double about_rounding = 1e-13;

/// Rows that do not sum to one are looked at again, with so much of what their pairs may be off by,
/// at most so often.
constexpr double share_again = 0.1;
constexpr int most_times_again = 3;
/// But for those whose sums were off by as much before, but for this share: what is found ten times
/// as exactly does not stay as it was. Where walls do not quite meet rows leak.
constexpr double hardly_changed = 0.05;

/// A pair that something may come between, and where its result belongs.
struct HardPair {
  int low, high;
  std::size_t place;
  int own, other;  ///< the same two: what is integrated over first, and what it looks at
  SightTolerance tolerance = {};
  bool is_done = false;
  bool is_seen = false;           ///< in part, at least
  double cell_points = HUGE_VAL;  ///< that cells are expected to take in all
  double need = HUGE_VAL;         ///< ErrorShares::claim, once few points were looked at
};

HardPair hard_pair(const SightScene& sight, int low, int high, std::size_t place) {
  // From the smaller one the larger looks more alike. Rounding does not decide.
  constexpr double clearly = 1 - 1e-9;
  const bool is_swapped = sight.surfaces[at(high)].area < clearly * sight.surfaces[at(low)].area;
  return {low, high, place, is_swapped ? high : low, is_swapped ? low : high};
}

/// From which of the two surfaces of a pair lattices look, and at which.
enum class LookFrom { own, other };

int looking(const HardPair& pair, LookFrom side) {
  return side == LookFrom::own ? pair.own : pair.other;
}
int seen_from(const HardPair& pair, LookFrom side) {
  return side == LookFrom::own ? pair.other : pair.own;
}

/// Before lattices of many points are made, cells may take so many: where kinks are few, these are
/// enough for any tolerance. From there on their error shrinks with this power of the number of
/// points, or faster. Those that are expected to take so many times as many look from lattices; and
/// again after more points of cells, which tell better what they will take.
constexpr std::array<int, 2> few_cell_points = {500, 5000};
constexpr double decay_of_cells = 1.6, many_more = 10;
/// Pairs that look from such lattices together, for each keeps what it sees.
constexpr std::size_t pairs_of_lattice = 16;

/// So many surfaces of one plane are looked from at another plane before what was seen is
/// forgotten: what these look back at is then found once for all of them.
constexpr int surfaces_of_task = 16;

/// Puts pairs of the same two joined surfaces next to each other. Returns where tasks end.
std::vector<std::size_t> sort_into_tasks(const SightScene& sight, std::vector<HardPair>& hard) {
  std::vector<int> place(sight.surfaces.size());
  for (const auto& parts : sight.joined.parts)
    for (std::size_t k = 0; k < parts.size(); ++k) place[at(parts[k])] = static_cast<int>(k);
  const auto task_of = [&](const HardPair& pair) {
    return std::array{sight.surfaces[at(pair.own)].joined, sight.surfaces[at(pair.other)].joined,
                      place[at(pair.own)] / surfaces_of_task};
  };
  std::sort(hard.begin(), hard.end(), [&](const HardPair& a, const HardPair& b) {
    return std::tuple(task_of(a), a.own, a.other) < std::tuple(task_of(b), b.own, b.other);
  });
  std::vector<std::size_t> ends;
  for (std::size_t h = 1; h <= hard.size(); ++h)
    if (h == hard.size() || task_of(hard[h]) != task_of(hard[h - 1])) ends.push_back(h);
  return ends;
}

/// What pairs of a scene see of each other, one way after the other.
class ExactPairs {
 public:
  ExactPairs(const FactorScene& scene, const SightScene& sight, const FactorOptions& options,
             const Progress& progress)
      : scene_(scene),
        sight_(sight),
        // Most of it for pairs that are not clear: the others take little.
        for_clear_{0.1 * options.tolerance, 0, options.max_points},
        for_partial_{0.8 * options.tolerance, 0, options.max_points},
        progress_(progress),
        pairs_(find_pairs(scene, sight, progress)),
        shares_(scene, pairs_, for_partial_.relative),
        found_(pairs_.size()) {
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      found_[a].resize(pairs_[a].size());
      for (std::size_t k = 0; k < pairs_[a].size(); ++k)
        if (pairs_[a][k].sight == Sight::clear)
          ++clear_pairs_;
        else
          hard_.push_back(hard_pair(sight, static_cast<int>(a), pairs_[a][k].other, k));
    }
    for (HardPair& pair : hard_) {
      pair.tolerance = for_partial_;
      pair.tolerance.absolute = shares_.even_share(row(pair), other_row(pair));
    }
  }

  /// These return false if stopped.
  bool see_clear() {
    const auto see = [&](std::size_t a) {
      for (std::size_t k = 0; k < pairs_[a].size(); ++k)
        if (pairs_[a][k].sight == Sight::clear)
          found_[a][k] = see_clear(static_cast<int>(a), pairs_[a][k].other);
    };
    return parallel_for(pairs_.size(), see, progress_, "form factors");
  }

  bool see_partial() {
    if (!try_shared()) return false;
    for (const LookFrom from : {LookFrom::own, LookFrom::other}) {
      if (!see_by_lattices(from)) return false;
      share_out();
    }
    return see_the_hardest();
  }

  /// Pairs of these rows that something may come between once more, so much more exactly, but for
  /// those that took all points that they may.
  bool see_again(const std::vector<bool>& rows, double share) {
    hard_.clear();  // those that are not found so exactly have taken all points
    const auto is_asked = [&](int row) { return row >= 0 && rows[at(row)]; };
    for (std::size_t a = 0; a < pairs_.size(); ++a)
      for (std::size_t k = 0; k < pairs_[a].size(); ++k) {
        if (pairs_[a][k].sight == Sight::clear || found_[a][k].is_at_limit) continue;
        HardPair pair = hard_pair(sight_, static_cast<int>(a), pairs_[a][k].other, k);
        if (!is_asked(row(pair)) && !is_asked(other_row(pair))) continue;
        pair.is_seen = true;
        pair.tolerance = for_partial_;
        pair.tolerance.relative *= share;
        pair.tolerance.absolute = share * shares_.even_share(row(pair), other_row(pair));
        hard_.push_back(pair);
      }
    return see_by_few_points() && see_the_hardest();
  }

  RowExchange exchange() const {
    RowExchange exchange(scene_.rows());
    std::vector<std::map<int, JointError>> partial(at(scene_.rows()));
    for (std::size_t a = 0; a < pairs_.size(); ++a)
      for (std::size_t k = 0; k < found_[a].size(); ++k) {
        const int row = scene_.row[a], other = scene_.row[at(pairs_[a][k].other)];
        MutualSight seen = found_[a][k];
        if (pairs_[a][k].sight == Sight::partial) {
          const auto [low, high] = ErrorShares::entry_of(row, other);
          partial[at(low)][high].add(std::exchange(seen.error, 0));
        }
        exchange.add(row, other, pairs_[a][k].sight, seen);
      }
    for (int row = 0; row < scene_.rows(); ++row)
      for (const auto& [other, error] : partial[at(row)])
        exchange.add(row, other, 0, error.bound());
    return exchange;
  }

 private:
  MutualSight see_clear(int a, int b) const {
    const MutualSight seen = clear_sight(sight_, a, b, for_clear_, progress_.stop);
    const double area = std::min(sight_.surfaces[at(a)].area, sight_.surfaces[at(b)].area);
    if (clear_pairs_ > few_clear_pairs || seen.error <= about_rounding * area) return seen;
    const SightTolerance fine{about_rounding, about_rounding * area,
                              std::min(points_to_rounding, for_clear_.max_points)};
    MutualSight better = clear_sight(sight_, a, b, fine, progress_.stop);
    if (!(better.error < seen.error)) return seen;
    better.is_reached = seen.is_reached;
    better.is_at_limit = seen.is_at_limit;
    return better;
  }

  int row(const HardPair& pair) const { return scene_.row[at(pair.low)]; }
  int other_row(const HardPair& pair) const { return scene_.row[at(pair.high)]; }
  MutualSight& sight_of(const HardPair& pair) { return found_[at(pair.low)][pair.place]; }

  /// Where many pairs share what an entry may be off by, few points of each tell which of them need
  /// more of it.
  bool try_shared() {
    for (HardPair& pair : hard_)
      pair.tolerance.is_trial = shares_.is_shared(row(pair), other_row(pair));
    const auto are_all = std::stable_partition(
        hard_.begin(), hard_.end(), [](const HardPair& pair) { return pair.tolerance.is_trial; });
    std::vector<HardPair> untried(are_all, hard_.end());
    hard_.erase(are_all, hard_.end());
    const bool is_complete =
        hard_.empty() || (see_by_few_points() && see_by_cells(for_partial_.max_points));
    for (HardPair& pair : hard_) pair.tolerance.is_trial = false;
    share_out();
    hard_.insert(hard_.end(), untried.begin(), untried.end());
    return is_complete;
  }

  /// Keeps the better one of what was seen.
  void note(const MutualSight& seen, HardPair& pair) {
    MutualSight& best = sight_of(pair);
    if (!pair.is_seen || seen.is_reached || seen.error < best.error) best = seen;
    best.is_at_limit = seen.is_at_limit;
    pair.is_seen = true;
    pair.is_done = seen.is_reached;
    pair.need = std::min(pair.need, seen.error * static_cast<double>(seen.points));
  }

  void drop_done() {
    for (const HardPair& pair : hard_)
      if (pair.is_done) shares_.spend(row(pair), other_row(pair), sight_of(pair).error);
    std::erase_if(hard_, [](const HardPair& pair) { return pair.is_done; });
  }

  /// What those that are done leave to those that have been tried.
  void share_out() {
    shares_.forget_claims();
    for (const HardPair& pair : hard_) shares_.claim(row(pair), other_row(pair), pair.need);
    for (HardPair& pair : hard_)
      pair.tolerance.absolute = shares_.share(row(pair), other_row(pair), pair.need);
  }

  bool see_by_few_points() {
    return see_by_lattices(LookFrom::own) && see_by_lattices(LookFrom::other);
  }

  /// Pairs that few points of lattices are not enough for.
  bool see_the_hardest() {
    const int most = for_partial_.max_points;
    for (const int few : few_cell_points)
      if (few < most && !(see_by_cells(few) && see_by_lattices(LookFrom::own, few) &&
                          see_by_lattices(LookFrom::other, few)))
        return false;
    return see_by_cells(most);
  }

  /// Partial pairs that lattices of few points are enough for; those are done then. After so many
  /// points of cells: of many points, those that are expected to take many more.
  bool see_by_lattices(LookFrom side, int cell_points = 0) {
    const bool are_many = cell_points > 0;
    std::vector<std::vector<std::size_t>> from(sight_.surfaces.size());
    for (std::size_t h = 0; h < hard_.size(); ++h)
      if (!are_many || hard_[h].cell_points > many_more * cell_points)
        from[at(looking(hard_[h], side))].push_back(h);
    std::vector<std::span<const std::size_t>> tasks;
    for (const std::span<const std::size_t> all : from) {
      const std::size_t together =
          are_many ? pairs_of_lattice : std::max<std::size_t>(all.size(), 1);
      for (std::size_t k = 0; k < all.size(); k += together)
        tasks.push_back(all.subspan(k, std::min(together, all.size() - k)));
    }
    const auto see = [&](std::size_t task) {
      std::vector<LatticePair> some;
      for (const std::size_t h : tasks[task]) {
        const HardPair& pair = hard_[h];
        SightTolerance tolerance = pair.tolerance;
        tolerance.max_points =
            static_cast<int>(std::min<double>(tolerance.max_points, pair.cell_points));
        const bool to_the_end =
            cell_points == few_cell_points.back() && pair.cell_points > pair.tolerance.max_points;
        some.push_back({seen_from(pair, side), tolerance, pairs_[at(pair.low)][pair.place].blockers,
                        to_the_end});
      }
      const auto seen =
          lattice_sight(sight_, looking(hard_[tasks[task].front()], side), some,
                        are_many ? most_lattice_places : few_lattice_places, progress_.stop);
      for (std::size_t k = 0; k < seen.size(); ++k) {
        HardPair& pair = hard_[tasks[task][k]];
        if (seen[k] && (seen[k]->is_reached || are_many || pair.tolerance.is_trial))
          note(*seen[k], pair);
      }
    };
    const bool is_complete = parallel_for(tasks.size(), see, progress_, "hidden form factors");
    drop_done();
    return is_complete;
  }

  /// Partial pairs by cells of so many points at most; in a trial those that lattices say nothing
  /// of.
  bool see_by_cells(int most_points) {
    const std::vector<std::size_t> ends = sort_into_tasks(sight_, hard_);
    const auto see = [&](std::size_t task) {
      PointLooks looks(sight_);
      for (std::size_t h = task == 0 ? 0 : ends[task - 1]; h < ends[task]; ++h) {
        HardPair& pair = hard_[h];
        if (pair.tolerance.is_trial && pair.need < HUGE_VAL) continue;
        SightTolerance tolerance = pair.tolerance;
        tolerance.max_points = most_points;
        const MutualSight seen =
            partial_sight(sight_, looks, pair.own, pair.other, tolerance, progress_.stop);
        note(seen, pair);
        pair.cell_points = static_cast<double>(seen.points) *
                           std::pow(seen.error / tolerance.allowed(seen.value), 1 / decay_of_cells);
      }
    };
    const bool is_complete = parallel_for(ends.size(), see, progress_, "hidden form factors");
    drop_done();
    return is_complete && !progress_.stopped();
  }

  const FactorScene& scene_;
  const SightScene& sight_;
  SightTolerance for_clear_, for_partial_;
  const Progress& progress_;
  std::vector<std::vector<SightPair>> pairs_;
  ErrorShares shares_;
  std::vector<std::vector<MutualSight>> found_;  // of pairs_
  std::size_t clear_pairs_ = 0;
  std::vector<HardPair> hard_;  // that are not found yet
};

/// Rows whose sums tell that an entry is off by more than it claims, and so far that it matters.
std::vector<bool> refuted_rows(const RowSums& sums, double tolerance) {
  std::vector<bool> rows;
  for (Eigen::Index i = 0; i < sums.area.size(); ++i) {
    const double missing = sums.missing[i] / sums.area[i];
    rows.push_back(missing > 2 * tolerance || (missing > tolerance / 2 && sums.is_refuted(i)));
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
