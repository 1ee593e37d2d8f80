#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/sound_scene.h"
#include "meshing/geometry/ball.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Round the mean of some points.
Ball ball_round(std::span<const Vec3> points);

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
  Ball ball;         ///< round it
  Vec3 low, high;    ///< the box round it
  double width = 0;  ///< least distance from a side to the farthest vertex, scene units
};

/// Whether some point of one surface, in or on the body, may look through its inside at points of
/// another one that lie outside, or on the body: no silhouette tells what its sides hide then.
/// What lies outside looks at nothing inside. Both are of convex pieces.
bool is_within_sight(const ConvexBody& body, const std::vector<std::vector<Vec3>>& looking,
                     const std::vector<std::vector<Vec3>>& seen);

/// The edges of a body between sides that a point sees and sides that it does not.
struct Silhouette {
  struct Edge {
    Vec3 normal;          ///< of the plane through the point and the edge; outwards, any length
    Vec3 corner;          ///< an end of it
    std::uint32_t index;  ///< of ConvexBody::edges
  };
  std::vector<Edge> edges;
  std::vector<char> is_front;  ///< each side
};

/// Which sides a point sees; in `is_front`, whose memory is used again.
void find_fronts(const ConvexBody& body, const Vec3& point, std::vector<char>& is_front);

/// As seen from a point; in `silhouette`, whose memory is used again.
void find_silhouette(const ConvexBody& body, const Vec3& point, Silhouette& silhouette);

struct ConvexBodies {
  std::vector<ConvexBody> bodies;
  std::vector<int> of;  ///< surface → body; −1: none
};

/// Surfaces that share all their edges with each other and with nothing else, and have the others
/// behind them. `opaque` must be made of `scene`.
ConvexBodies find_convex_bodies(const SoundScene& scene, const OpaqueScene& opaque);

}  // namespace halfshade
