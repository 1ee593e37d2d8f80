#include "solver/factors/surface_exchange.h"

#include "meshing/core/parallel.h"
#include "solver/factors/lattice_sight.h"
#include "solver/factors/pair_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace halfshade {
namespace {

/// What entries are off by adds up like the root of their number, if there are many; of that,
/// estimates of lattices are at least this many times as much. Where there are few, they count as
/// more.
double parts_of_row(double entries) {
  constexpr double few = 0.25, many = 0.5, overestimated = 5.5;
  return std::max(std::pow(entries, few), std::pow(entries, many) / overestimated);
}

/// So few clear pairs are found to rounding in half a second, and are then, whatever is asked for:
/// what rules say that they are off by is far more than they are. None takes more points for that.
constexpr std::size_t few_clear_pairs = 10000;
constexpr int points_to_rounding = 5000;
constexpr double about_rounding = 1e-13;

/// How errors are shared out so that no entry is off by more than the tolerance, and rows, whose
/// entries are off independently of each other, hardly by more.
class ErrorShares {
 public:
  ErrorShares(const FactorScene& scene, const std::vector<std::vector<SightPair>>& pairs)
      : scene_(scene), of_row_(at(scene.rows())), of_entry_(at(scene.rows())) {
    for (std::size_t a = 0; a < pairs.size(); ++a)
      for (const SightPair& pair : pairs[a]) {
        if (pair.sight != Sight::partial) continue;
        const int row = scene.row[a], other = scene.row[at(pair.other)];
        of_row_[at(row)] += 1;
        if (other >= 0 && other != row) of_row_[at(other)] += 1;
        entry(row, other) += 1;
      }
  }

  /// Mutual area that a pair may be off by.
  double share(int row, int other, double tolerance) const {
    double area = scene_.areas[at(row)], in_row = of_row_[at(row)];
    if (other >= 0) {
      area = std::min(area, scene_.areas[at(other)]);
      in_row = std::max(in_row, of_row_[at(other)]);
    }
    const auto found = of_entry_[at(key(row, other)[0])].find(key(row, other)[1]);
    const double in_entry = found == of_entry_[at(key(row, other)[0])].end() ? 1 : found->second;
    return tolerance * area / std::max({1., in_entry, parts_of_row(in_row)});
  }

 private:
  /// Surroundings and backs are one entry.
  static std::array<int, 2> key(int row, int other) {
    return other < 0 ? std::array{row, -1} : std::array{std::min(row, other), std::max(row, other)};
  }
  double& entry(int row, int other) {
    return of_entry_[at(key(row, other)[0])][key(row, other)[1]];
  }

  const FactorScene& scene_;
  std::vector<double> of_row_;
  std::vector<std::map<int, double>> of_entry_;
};

/// A pair that something may come between, and where its result belongs.
struct HardPair {
  int low, high;
  std::size_t place;
  int own, other;  ///< the same two: what is integrated over first, and what it looks at
};

HardPair hard_pair(const SightScene& sight, int low, int high, std::size_t place) {
  // From the smaller one the larger looks more alike. Rounding does not decide.
  constexpr double clearly = 1 - 1e-9;
  const bool is_swapped = sight.surfaces[at(high)].area < clearly * sight.surfaces[at(low)].area;
  return {low, high, place, is_swapped ? high : low, is_swapped ? low : high};
}

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
        shares_(scene, pairs_),
        found_(pairs_.size()) {
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      found_[a].resize(pairs_[a].size());
      for (std::size_t k = 0; k < pairs_[a].size(); ++k)
        if (pairs_[a][k].sight == Sight::clear)
          ++clear_pairs_;
        else
          hard_.push_back(hard_pair(sight, static_cast<int>(a), pairs_[a][k].other, k));
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

  /// Partial pairs that lattices of points are enough for, on the surface of each pair that is
  /// looked from first, or on the other one; those are done then.
  bool see_by_lattices(bool looks_back) {
    std::vector<std::vector<std::size_t>> from(sight_.surfaces.size());
    for (std::size_t h = 0; h < hard_.size(); ++h)
      from[at(looks_back ? hard_[h].other : hard_[h].own)].push_back(h);
    std::vector<char> is_done(hard_.size(), 0);
    const auto see = [&](std::size_t s) {
      std::vector<LatticePair> some;
      for (const std::size_t h : from[s])
        some.push_back({looks_back ? hard_[h].own : hard_[h].other, tolerance_of(hard_[h]),
                        pairs_[at(hard_[h].low)][hard_[h].place].blockers});
      const auto seen = lattice_sight(sight_, static_cast<int>(s), some);
      for (std::size_t k = 0; k < seen.size(); ++k) {
        if (!seen[k]) continue;
        sight_of(hard_[from[s][k]]) = *seen[k];
        is_done[from[s][k]] = 1;
      }
    };
    const bool is_complete = parallel_for(from.size(), see, progress_, "hidden form factors");
    std::size_t left = 0;
    for (std::size_t h = 0; h < hard_.size(); ++h)
      if (!is_done[h]) hard_[left++] = hard_[h];
    hard_.resize(left);
    return is_complete;
  }

  /// The other partial pairs.
  bool see_by_cells() {
    const std::vector<std::size_t> ends = sort_into_tasks(sight_, hard_);
    const auto see = [&](std::size_t task) {
      PointLooks looks(sight_);
      for (std::size_t h = task == 0 ? 0 : ends[task - 1]; h < ends[task]; ++h)
        sight_of(hard_[h]) = partial_sight(sight_, looks, hard_[h].own, hard_[h].other,
                                           tolerance_of(hard_[h]), progress_.stop);
    };
    return parallel_for(ends.size(), see, progress_, "hidden form factors") && !progress_.stopped();
  }

  void add_to(RowExchange& exchange) const {
    for (std::size_t a = 0; a < pairs_.size(); ++a)
      for (std::size_t k = 0; k < found_[a].size(); ++k)
        exchange.add(scene_.row[a], scene_.row[at(pairs_[a][k].other)], pairs_[a][k].sight,
                     found_[a][k]);
  }

 private:
  MutualSight see_clear(int a, int b) const {
    const MutualSight seen = clear_sight(sight_, a, b, for_clear_);
    const double area = std::min(sight_.surfaces[at(a)].area, sight_.surfaces[at(b)].area);
    if (clear_pairs_ > few_clear_pairs || seen.error <= about_rounding * area) return seen;
    const SightTolerance fine{about_rounding, about_rounding * area,
                              std::min(points_to_rounding, for_clear_.max_points)};
    const MutualSight better = clear_sight(sight_, a, b, fine);
    return better.error < seen.error ? better : seen;
  }

  SightTolerance tolerance_of(const HardPair& pair) const {
    const int row = scene_.row[at(pair.low)], other = scene_.row[at(pair.high)];
    SightTolerance tolerance = for_partial_;
    tolerance.absolute = shares_.share(row, other, tolerance.relative);
    return tolerance;
  }
  MutualSight& sight_of(const HardPair& pair) { return found_[at(pair.low)][pair.place]; }

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
}

RowExchange exact_exchange(const FactorScene& scene, const SightScene& sight,
                           const FactorOptions& options, const Progress& progress) {
  ExactPairs pairs(scene, sight, options, progress);
  RowExchange exchange(scene.rows());
  exchange.report.is_complete = pairs.see_clear() && pairs.see_by_lattices(false) &&
                                pairs.see_by_lattices(true) && pairs.see_by_cells();
  pairs.add_to(exchange);
  return exchange;
}

}  // namespace halfshade
