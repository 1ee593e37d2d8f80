#pragma once

#include "solver/factors/mutual_sight.h"
#include "solver/factors/sight_scene.h"

#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace halfshade {

/// A surface and a convex body that it looks at as a whole.
struct BodyPair {
  int surface = 0, body = 0;
  /// Sides of the body that nothing comes between, rising: they do not count.
  std::vector<int> clear;
};

/// Mutual area of a surface and those sides of a body that something may come between: one look
/// at what is inside its outline serves all of them. From all of the surface, by lattices, as
/// lattice_sight; nothing where these tell nothing, or BodyTarget is not applicable. `sides` are
/// all surfaces of the body; `most_places` are those of a lattice. If stopped, nothing. Cost: some
/// ten microseconds a point for bodies of hundreds of sides.
std::optional<MutualSight> body_sight(const SightScene& scene, const BodyPair& pair,
                                      std::span<const int> sides, const SightTolerance& tolerance,
                                      std::size_t most_places, const std::stop_token& stop = {});

}  // namespace halfshade
