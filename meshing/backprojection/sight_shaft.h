#pragma once

#include "meshing/backprojection/border_lines.h"
#include "meshing/backprojection/four_planes.h"
#include "meshing/geometry/flat_tree.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Holds the pyramids that a few points span with an emitter, each up to the emitter's plane.
struct SightShaft {
  /// Through border lines, as far outwards as any point has them on one side of the emitter's plane
  /// and on the other: what lies outside both is outside in the view of each point.
  std::vector<std::array<FourPlanes, 2>> sides;
  Vec3 normal = Vec3::Zero(), span = Vec3::Zero();  ///< of the emitter's plane, see FourPlanes
  double nearest = 0, farthest = 0;                 ///< normal · x, of the plane and of the points
  double slack = 0, spread = 0;                     ///< see SightPyramid

  /// Points behind the emitter count for nothing.
  void make(const OpaqueTopology::OpaqueSurface& emitter, std::span<const BorderLine> lines,
            std::span<const Vec3> points);

  /// Whether nothing in the box comes between any of the points and the emitter. Never true of what
  /// SightPyramid looks at.
  bool is_outside(const Bounds& box) const;
};

}  // namespace halfshade
