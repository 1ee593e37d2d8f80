#pragma once

#include "solver/factors/body_sight.h"
#include "solver/factors/factor_scene.h"
#include "solver/factors/pair_search.h"
#include "solver/factors/sight_scene.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Where a pair is in what find_pairs returns.
struct PairPlace {
  int low;            ///< the surface
  std::size_t place;  ///< among its pairs
};

/// A pair of a surface and a body, and those of its pairs of surfaces that it stands for.
struct JoinedPairs {
  BodyPair whole;
  std::vector<PairPlace> parts;  ///< partial, never none
};

/// Surfaces of each body that is a part of one row alone, rising; none of other bodies.
std::vector<std::vector<int>> sides_of_bodies(const FactorScene& scene, const SightScene& sight);

/// Pairs of surfaces that are better looked at as a surface and a body: many that something may
/// come between, of one surface and sides of one body, where these have one row. `pairs` are those
/// of find_pairs, `sides` of sides_of_bodies. No pair is a part of two.
std::vector<JoinedPairs> find_body_pairs(const SightScene& sight,
                                         const std::vector<std::vector<SightPair>>& pairs,
                                         const std::vector<std::vector<int>>& sides);

}  // namespace halfshade
