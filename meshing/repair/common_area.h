#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"

#include <span>

namespace halfshade {

/// Whether two polygons, seen along a plane's normal, lie over each other, and not just in slivers
/// along their borders no wider than the planarity. Neither needs to be convex.
bool have_common_area(std::span<const Vec3> a, std::span<const Vec3> b, const PlaneFrame& plane,
                      const LocalTolerance& tolerance);

}  // namespace halfshade
