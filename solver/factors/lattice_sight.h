#pragma once

#include "solver/factors/mutual_sight.h"
#include "solver/factors/sight_scene.h"

#include <optional>
#include <span>
#include <vector>

namespace halfshade {

/// What surface is looked at, and how exactly.
struct LatticePair {
  int other;
  SightTolerance tolerance;
  std::span<const int> blockers = {};  ///< SightPair::blockers
};

/// Mutual areas of surface `a` and others, with what is between them: what they would see without
/// it less what it hides, which is integrated over all of `a` by lattices of points. Where kinks
/// are everywhere that takes a fraction of the points that partial_sight takes, whose cells follow
/// each of them; and points serve all pairs. Nothing for pairs that no lattice of 4,096 points
/// suffices for, or that are all or nothing from all points. In a trial 64 points are the most, and
/// what is not reached is told, too. If
/// stopped, nothing. Cost: a microsecond a point and pair.
std::vector<std::optional<MutualSight>> lattice_sight(const SightScene& scene, int a,
                                                      std::span<const LatticePair> pairs,
                                                      const std::stop_token& stop = {});

}  // namespace halfshade
