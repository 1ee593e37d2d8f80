#pragma once

#include "solver/factors/mutual_sight.h"
#include "solver/factors/sight_scene.h"
#include "solver/factors/square_lattice.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace halfshade {

/// What surface is looked at, and how exactly.
struct LatticePair {
  int other;
  SightTolerance tolerance;
  std::span<const int> blockers = {};  ///< SightPair::blockers
  bool to_the_end = false;             ///< though no lattice is expected to be enough
};

/// Mutual areas of surface `a` and others, with what is between them: what they would see without
/// it less what it hides, which is integrated over all of `a` by lattices of at most `most_places`
/// points. Where kinks are everywhere that takes a fraction of the points that partial_sight takes,
/// whose cells follow each of them; and points serve all pairs. Nothing for pairs that are all or
/// nothing from all points, or that lattices have too few points for; others that they do not
/// suffice for are not reached. In a trial 64 points are the most. If stopped, nothing. Cost: a
/// microsecond a point and pair, and as long as it is not done eight bytes.
std::vector<std::optional<MutualSight>> lattice_sight(const SightScene& scene, int a,
                                                      std::span<const LatticePair> pairs,
                                                      std::size_t most_places = few_lattice_places,
                                                      const std::stop_token& stop = {});

}  // namespace halfshade
