#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/sound_scene.h"
#include "solver/factors/convex_bodies.h"

#include <vector>

namespace halfshade {

struct ConvexBodies {
  std::vector<ConvexBody> bodies;
  std::vector<int> of;  ///< surface → body; −1: none
};

/// Surfaces that have each other behind them, with what they share edges with beyond ridges:
/// closed, or open on one side, as boxes without a bottom are, or on two that other surfaces cover,
/// as legs between a floor and a table. `opaque` must be made of `scene`.
ConvexBodies find_convex_bodies(const SoundScene& scene, const OpaqueScene& opaque);

}  // namespace halfshade
