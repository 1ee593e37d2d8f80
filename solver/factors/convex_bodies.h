#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/sound_scene.h"

#include <array>
#include <vector>

namespace halfshade {

/// A convex solid, closed by convex polygons that look outwards.
struct ConvexBody {
  struct Side {
    Vec3 corner, normal;  ///< of its plane, unit length
  };
  struct Edge {
    std::array<int, 2> ends;   ///< as `left` runs along it
    std::array<int, 2> sides;  ///< to the left, and to the right
  };
  std::vector<Vec3> vertices;
  std::vector<Side> sides;
  std::vector<Edge> edges;
};

struct ConvexBodies {
  std::vector<ConvexBody> bodies;
  std::vector<int> of;  ///< surface → body; −1: none
};

/// Surfaces that share all their edges with each other and with nothing else, and have the others
/// behind them. `opaque` must be made of `scene`.
ConvexBodies find_convex_bodies(const SoundScene& scene, const OpaqueScene& opaque);

}  // namespace halfshade
