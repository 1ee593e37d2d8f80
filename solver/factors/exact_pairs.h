#pragma once

#include "meshing/core/progress.h"
#include "solver/factors/body_pairs.h"
#include "solver/factors/error_shares.h"
#include "solver/factors/factor_scene.h"
#include "solver/factors/mutual_sight.h"
#include "solver/factors/pair_search.h"
#include "solver/factors/sight_scene.h"
#include "solver/factors/surface_exchange.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace halfshade {

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

/// What pairs of a scene see of each other, one way after the other.
class ExactPairs {
 public:
  /// All must outlive it.
  ExactPairs(const FactorScene& scene, const SightScene& sight, const FactorOptions& options,
             const Progress& progress);

  /// These return false if stopped.
  bool see_clear();
  bool see_partial();
  /// Pairs of these rows that something may come between once more, so much more exactly, but for
  /// those that took all points that they may.
  bool see_again(const std::vector<bool>& rows, double share);

  RowExchange exchange() const;

 private:
  enum class LookFrom { own, other };

  MutualSight see_clear(int a, const SightPair& pair) const;
  bool see_bodies(const std::vector<bool>& rows, double share);
  bool try_shared();
  bool see_by_few_points();
  bool see_the_hardest();
  bool see_by_lattices(LookFrom side, int cell_points = 0);
  bool see_by_cells(int most_points);

  static int looking(const HardPair& pair, LookFrom side) {
    return side == LookFrom::own ? pair.own : pair.other;
  }
  static int seen_from(const HardPair& pair, LookFrom side) {
    return side == LookFrom::own ? pair.other : pair.own;
  }
  int row(const HardPair& pair) const { return scene_.row[at(pair.low)]; }
  int other_row(const HardPair& pair) const { return scene_.row[at(pair.high)]; }
  MutualSight& sight_of(const HardPair& pair) { return found_[at(pair.low)][pair.place]; }
  bool is_asked(const std::vector<bool>& rows, int low, std::size_t place) const;
  SightTolerance tolerance_of_pair(int row, int other_row, double share) const;
  std::array<int, 2> rows_of(const JoinedPairs& pairs) const;
  void join(JoinedPairs pairs);
  void note_whole(const JoinedPairs& pairs, const MutualSight& seen);
  void part(const JoinedPairs& pairs);
  void note(const MutualSight& seen, HardPair& pair);
  void drop_done();
  void share_out();

  const FactorScene& scene_;
  const SightScene& sight_;
  SightTolerance for_clear_, for_partial_;
  const Progress& progress_;
  std::vector<std::vector<SightPair>> pairs_;
  ErrorShares shares_;
  std::vector<std::vector<MutualSight>> found_;  // of pairs_
  std::size_t clear_pairs_ = 0;
  std::vector<HardPair> hard_;  // that are not found yet
  // Pairs of surfaces and bodies, and the pairs that they stand for: what is found is kept with the
  // first of these.
  std::vector<std::vector<int>> sides_;  // of bodies
  std::vector<JoinedPairs> bodies_;
  std::vector<std::vector<char>> is_joined_;  // of pairs_
};

}  // namespace halfshade
