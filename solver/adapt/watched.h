#pragma once

#include "meshing/core/types.h"
#include "solver/direct/direct_light.h"

#include <array>
#include <vector>

namespace halfshade {

/// Where something small may be that samples overlook.
struct WatchedPlace {
  FieldPoint place;
  double area;  ///< of it, squared scene units
};

/// The foot of a corner of something that touches a surface, or nearly does: around it a field
/// depends on the direction however close one comes, down to the height.
struct WatchedCorner {
  int surface;
  Vec3 foot;
  double height;
};

/// The feet of the ends of an edge that touches a surface nearly, and how high it is there: across
/// it a field changes within lengths like the height. The two heights differ less than the feet are
/// apart, and are not both 0.
struct WatchedEdge {
  int surface;
  std::array<Vec3, 2> feet;
  std::array<double, 2> height;
};

/// What samples of a field may overlook.
struct Watched {
  std::vector<WatchedPlace> places;
  std::vector<WatchedCorner> corners;
  std::vector<WatchedEdge> edges;
};

}  // namespace halfshade
