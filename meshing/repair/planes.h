#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"

#include <span>
#include <vector>

namespace halfshade {

/// The distinct planes of polygons.
struct PlaneClasses {
  std::vector<PlaneFrame> frames;  ///< one a plane
  std::vector<int> of_polygon;     ///< polygon → plane
};

/// Sorts planar polygons (loops of points, with an area) into planes. Two come into one plane if
/// they are near each other, directly or through others, and look the same way, to within what the
/// rounding of a file can have moved their corners (see tolerance_of); if they look opposite ways,
/// only if the digits that were written cannot tell their planes apart, for light passes through
/// the narrowest gap. Those between the same points, as front and back of a sheet, always do. What
/// looks the other way between two, as the back of a thin sheet does, keeps them apart. A two-sided
/// polygon looks both ways, whichever way round its corners go.
/// Deterministic; each polygon is compared with those near it only.
/// `scales` has one entry a loop, and so has `two_sided` unless it is empty: none is.
PlaneClasses classify_planes(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
                             std::span<const LocalScale> scales,
                             const std::vector<bool>& two_sided = {});

}  // namespace halfshade
