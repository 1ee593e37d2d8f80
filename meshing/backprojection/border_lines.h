#pragma once

#include "meshing/backprojection/opaque_topology.h"

#include <vector>

namespace halfshade {

/// A line in a surface's plane along its border, moved outwards until all of the surface lies on
/// one side.
struct BorderLine {
  Vec3 out;           ///< unit length, in the plane, away from the surface
  double offset = 0;  ///< out · (x − origin of the frame) on the line

  /// How far inside of the line a point is, seen along the normal.
  double inset(const PlaneFrame& frame, const Vec3& p) const {
    return offset - out.dot(p - frame.origin);
  }
};

/// One along each edge of the outer ring, or along some where there are very many.
std::vector<BorderLine> border_lines(const OpaqueTopology& topology, int surface);

}  // namespace halfshade
