#pragma once

#include "solver/factors/factor_scene.h"
#include "solver/factors/sight_scene.h"

#include <vector>

namespace halfshade {

struct SightPair {
  int other;
  Sight sight;                ///< never none
  std::vector<int> blockers;  ///< of convex pairs that are partial: all SightScene::blockers
                              ///< that reach into their hull; rising
  bool is_in_cells = false;   ///< is_clear_in_cells; not all of them is
};

/// For each surface with a row, those it may see: others with rows only once, by the lower of the
/// two, and then all that have none; rising. Groups of coplanar surfaces are looked at together
/// until nothing or one thing alone comes between them: a shaft for each pair of groups that is
/// cut.
std::vector<std::vector<SightPair>> find_pairs(const FactorScene& scene, const SightScene& sight,
                                               const Progress& progress);

}  // namespace halfshade
