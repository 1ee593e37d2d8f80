#include "solver/factors/exact_pairs.h"

#include "meshing/core/parallel.h"
#include "solver/factors/body_sight.h"
#include "solver/factors/lattice_sight.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace halfshade {
namespace {

/// So few clear pairs are found to rounding in half a second, and are then, whatever is asked for:
/// what rules say that they are off by is far more than they are. None takes more points for that.
constexpr std::size_t few_clear_pairs = 10000;
constexpr int points_to_rounding = 5000;
constexpr double about_rounding = 1e-13;

HardPair hard_pair(const SightScene& sight, int low, int high, std::size_t place) {
  // From the smaller one the larger looks more alike. Rounding does not decide.
  constexpr double clearly = 1 - 1e-9;
  const bool is_swapped = sight.surfaces[at(high)].area < clearly * sight.surfaces[at(low)].area;
  return {low, high, place, is_swapped ? high : low, is_swapped ? low : high};
}

/// Before lattices of many points are made, cells may take so many: where kinks are few, these are
/// enough for any tolerance. From there on their error shrinks with this power of the number of
/// points, or faster. Those that are expected to take so many times as many look from lattices; and
/// again after more points of cells, which tell better what they will take.
constexpr std::array<int, 2> few_cell_points = {500, 5000};
constexpr double decay_of_cells = 1.6, many_more = 10;
/// A look at a body takes as long as one at so many of its sides.
constexpr std::size_t sides_like_one = 8;
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

}  // namespace

ExactPairs::ExactPairs(const FactorScene& scene, const SightScene& sight,
                       const FactorOptions& options, const Progress& progress)
    : scene_(scene),
      sight_(sight),
      // Most of it for pairs that are not clear: the others take little.
      for_clear_{0.1 * options.tolerance, 0, options.max_points},
      for_partial_{0.8 * options.tolerance, 0, options.max_points},
      progress_(progress),
      pairs_(find_pairs(scene, sight, progress)),
      shares_(scene, pairs_, for_partial_.relative),
      found_(pairs_.size()),
      sides_(sides_of_bodies(scene, sight)),
      is_joined_(pairs_.size()) {
  for (std::size_t a = 0; a < pairs_.size(); ++a) {
    found_[a].resize(pairs_[a].size());
    is_joined_[a].resize(pairs_[a].size(), 0);
  }
  for (JoinedPairs& joined : find_body_pairs(sight, pairs_, sides_)) join(std::move(joined));
  for (std::size_t a = 0; a < pairs_.size(); ++a)
    for (std::size_t k = 0; k < pairs_[a].size(); ++k)
      if (pairs_[a][k].sight == Sight::clear)
        ++clear_pairs_;
      else if (is_joined_[a][k] == 0)
        hard_.push_back(hard_pair(sight, static_cast<int>(a), pairs_[a][k].other, k));
}

bool ExactPairs::see_clear() {
  const auto see = [&](std::size_t a) {
    for (std::size_t k = 0; k < pairs_[a].size(); ++k)
      if (pairs_[a][k].sight == Sight::clear)
        found_[a][k] = see_clear(static_cast<int>(a), pairs_[a][k]);
  };
  return parallel_for(pairs_.size(), see, progress_, "form factors");
}

bool ExactPairs::see_partial() {
  if (!see_bodies({}, 1)) return false;
  for (HardPair& pair : hard_) pair.tolerance = tolerance_of_pair(row(pair), other_row(pair), 1);
  if (!try_shared()) return false;
  for (const LookFrom from : {LookFrom::own, LookFrom::other}) {
    if (!see_by_lattices(from)) return false;
    share_out();
  }
  return see_the_hardest();
}

SightTolerance ExactPairs::tolerance_of_pair(int row, int other_row, double share) const {
  SightTolerance tolerance = for_partial_;
  tolerance.relative *= share;
  tolerance.absolute = share * shares_.even_share(row, other_row);
  return tolerance;
}

/// Whether a pair belongs to one of some rows; all do if there are none.
bool ExactPairs::is_asked(const std::vector<bool>& rows, int low, std::size_t place) const {
  const auto is_one = [&](int surface) {
    const int row = scene_.row[at(surface)];
    return row >= 0 && rows[at(row)];
  };
  return rows.empty() || is_one(low) || is_one(pairs_[at(low)][place].other);
}

std::array<int, 2> ExactPairs::rows_of(const JoinedPairs& pairs) const {
  const auto [low, place] = pairs.parts.front();
  return {scene_.row[at(low)], scene_.row[at(pairs_[at(low)][place].other)]};
}

void ExactPairs::join(JoinedPairs pairs) {
  for (const PairPlace& part : pairs.parts) is_joined_[at(part.low)][part.place] = 1;
  bodies_.push_back(std::move(pairs));
}

void ExactPairs::note_whole(const JoinedPairs& pairs, const MutualSight& seen) {
  const auto [low, place] = pairs.parts.front();
  found_[at(low)][place] = seen;
  const auto [row, other_row] = rows_of(pairs);
  shares_.spend(row, other_row, seen.error);
}

/// Those that it stands for are found one by one.
void ExactPairs::part(const JoinedPairs& pairs) {
  for (const auto& [low, place] : pairs.parts) {
    is_joined_[at(low)][place] = 0;
    found_[at(low)][place] = {};
    hard_.push_back(hard_pair(sight_, low, pairs_[at(low)][place].other, place));
  }
}

/// Bodies as wholes: those of these rows that are not found so are parted.
bool ExactPairs::see_bodies(const std::vector<bool>& rows, double share) {
  std::vector<std::size_t> asked;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (is_asked(rows, bodies_[b].parts.front().low, bodies_[b].parts.front().place))
      asked.push_back(b);
  std::vector<std::optional<MutualSight>> seen(bodies_.size());
  const auto see = [&](std::size_t k) {
    const JoinedPairs& pairs = bodies_[asked[k]];
    const auto [row, other_row] = rows_of(pairs);
    SightTolerance tolerance = for_partial_;
    tolerance.relative *= share;
    tolerance.absolute = share * shares_.joint_share(row, other_row, pairs.parts.size());
    // Its sides take as many one by one; and of those whose kinks are few, cells take less.
    const std::size_t most_places =
        few_lattice_places * std::max<std::size_t>(pairs.parts.size() / sides_like_one, 1);
    seen[asked[k]] = body_sight(sight_, pairs.whole, sides_[at(pairs.whole.body)], tolerance,
                                std::min(most_places, most_lattice_places), progress_.stop);
  };
  const bool is_complete = parallel_for(asked.size(), see, progress_, "hidden form factors");
  std::vector<JoinedPairs> kept;
  for (std::size_t b = 0, k = 0; b < bodies_.size(); ++b) {
    const bool is_new = k < asked.size() && asked[k] == b;
    k += is_new ? 1 : 0;
    if (is_new && seen[b] && seen[b]->is_reached)
      note_whole(bodies_[b], *seen[b]);
    else if (is_new) {
      part(bodies_[b]);
      continue;
    }
    kept.push_back(std::move(bodies_[b]));
  }
  bodies_ = std::move(kept);
  return is_complete;
}

bool ExactPairs::see_again(const std::vector<bool>& rows, double share) {
  hard_.clear();  // those that are not found so exactly have taken all points
  for (std::size_t a = 0; a < pairs_.size(); ++a)
    for (std::size_t k = 0; k < pairs_[a].size(); ++k) {
      const bool is_left = is_joined_[a][k] != 0 || found_[a][k].is_at_limit;
      if (pairs_[a][k].sight == Sight::clear || is_left) continue;
      if (!is_asked(rows, static_cast<int>(a), k)) continue;
      hard_.push_back(hard_pair(sight_, static_cast<int>(a), pairs_[a][k].other, k));
      hard_.back().is_seen = true;
    }
  if (!see_bodies(rows, share)) return false;
  for (HardPair& pair : hard_)
    pair.tolerance = tolerance_of_pair(row(pair), other_row(pair), share);
  return see_by_few_points() && see_the_hardest();
}

RowExchange ExactPairs::exchange() const {
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
    for (const auto& [other, error] : partial[at(row)]) exchange.add(row, other, 0, error.bound());
  return exchange;
}

MutualSight ExactPairs::see_clear(int a, const SightPair& pair) const {
  const int b = pair.other;
  const auto see = [&](const SightTolerance& tolerance) {
    return pair.is_in_cells ? clear_sight_in_cells(sight_, a, b, tolerance, progress_.stop)
                            : clear_sight(sight_, a, b, tolerance, progress_.stop);
  };
  const MutualSight seen = see(for_clear_);
  const double area = std::min(sight_.surfaces[at(a)].area, sight_.surfaces[at(b)].area);
  if (clear_pairs_ > few_clear_pairs || seen.error <= about_rounding * area) return seen;
  const SightTolerance fine{about_rounding, about_rounding * area,
                            std::min(points_to_rounding, for_clear_.max_points)};
  MutualSight better = see(fine);
  if (!(better.error < seen.error)) return seen;
  better.is_reached = seen.is_reached;
  better.is_at_limit = seen.is_at_limit;
  return better;
}

/// Where many pairs share what an entry may be off by, few points of each tell which of them need
/// more of it.
bool ExactPairs::try_shared() {
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
void ExactPairs::note(const MutualSight& seen, HardPair& pair) {
  MutualSight& best = sight_of(pair);
  if (!pair.is_seen || seen.is_reached || seen.error < best.error) best = seen;
  best.is_at_limit = seen.is_at_limit;
  pair.is_seen = true;
  pair.is_done = seen.is_reached;
  pair.need = std::min(pair.need, seen.error * static_cast<double>(seen.points));
}

void ExactPairs::drop_done() {
  for (const HardPair& pair : hard_)
    if (pair.is_done) shares_.spend(row(pair), other_row(pair), sight_of(pair).error);
  std::erase_if(hard_, [](const HardPair& pair) { return pair.is_done; });
}

/// What those that are done leave to those that have been tried.
void ExactPairs::share_out() {
  shares_.forget_claims();
  for (const HardPair& pair : hard_) shares_.claim(row(pair), other_row(pair), pair.need);
  for (HardPair& pair : hard_)
    pair.tolerance.absolute = shares_.share(row(pair), other_row(pair), pair.need);
}

bool ExactPairs::see_by_few_points() {
  return see_by_lattices(LookFrom::own) && see_by_lattices(LookFrom::other);
}

/// Pairs that few points of lattices are not enough for.
bool ExactPairs::see_the_hardest() {
  const int most = for_partial_.max_points;
  for (const int few : few_cell_points)
    if (few < most && !(see_by_cells(few) && see_by_lattices(LookFrom::own, few) &&
                        see_by_lattices(LookFrom::other, few)))
      return false;
  return see_by_cells(most);
}

/// Partial pairs that lattices of few points are enough for; those are done then. After so many
/// points of cells: of many points, those that are expected to take many more.
bool ExactPairs::see_by_lattices(LookFrom side, int cell_points) {
  const bool are_many = cell_points > 0;
  std::vector<std::vector<std::size_t>> from(sight_.surfaces.size());
  for (std::size_t h = 0; h < hard_.size(); ++h)
    if (!are_many || hard_[h].cell_points > many_more * cell_points)
      from[at(looking(hard_[h], side))].push_back(h);
  std::vector<std::span<const std::size_t>> tasks;
  for (const std::span<const std::size_t> all : from) {
    const std::size_t together = are_many ? pairs_of_lattice : std::max<std::size_t>(all.size(), 1);
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
bool ExactPairs::see_by_cells(int most_points) {
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

}  // namespace halfshade
