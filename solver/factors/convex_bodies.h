#pragma once

#include "meshing/geometry/ball.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Round the mean of some points.
Ball ball_round(std::span<const Vec3> points);

/// A convex solid, closed by convex polygons that look outwards, but for some sides that are open.
/// No light passes through it from outside: there is one such side alone, or others lie on them.
struct ConvexBody {
  struct Side {
    Vec3 corner, normal;  ///< of its plane, unit length
  };
  struct Edge {
    std::array<int, 2> ends;   ///< as `left` runs along it
    std::array<int, 2> sides;  ///< to the left, and to the right
  };
  std::vector<Vec3> vertices;
  std::vector<Side> sides;  ///< open ones last
  std::size_t open_sides = 0;
  std::vector<Edge> edges;
  Ball ball;         ///< round it
  double inner = 0;  ///< radius of a ball with the same centre that lies in it
  Vec3 low, high;    ///< the box round it
  double width = 0;  ///< least distance from a side to the farthest vertex, scene units
};

/// A flat surface.
struct FlatSurface {
  const std::vector<std::vector<Vec3>>& pieces;  ///< convex
  Vec3 normal;
};

/// Of lengths at the body, scene units.
double rounding_of(const ConvexBody& body);

/// Whether any of a surface lies in it, or on it.
bool reaches_into(const ConvexBody& body, const FlatSurface& surface);

/// Whether its sides may hide anything else from one surface of another than what a solid would.
/// If it is closed: where some point of one, in or on the body, looks through its inside at the
/// other, outside or on it. What lies outside looks at nothing inside. If it is open: unless both
/// lie outside, or one of them does and the other one on an open side, looking in.
bool is_within_sight(const ConvexBody& body, const FlatSurface& looking, const FlatSurface& seen);

/// Whether a convex polygon clearly lies beyond a side of the body, or on or beyond an open one.
/// Some that lie outside do not.
bool lies_outside(const ConvexBody& body, std::span<const Vec3> polygon);

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

/// As seen from a point; in `silhouette`, whose memory is used again. No edges from inside.
void find_silhouette(const ConvexBody& body, const Vec3& point, Silhouette& silhouette);

}  // namespace halfshade
