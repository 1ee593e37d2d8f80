#pragma once

#include "meshing/core/tolerance.h"
#include "meshing/repair/coplanar.h"

#include <array>
#include <vector>

namespace halfshade {

/// For each surface the straight pieces along which others cut through it, as pairs of points,
/// which are added. What only touches, within the planarity tolerance, does not cut.
std::vector<std::vector<std::array<int, 2>>> find_intersections(
    const std::vector<SurfaceDraft>& drafts, std::vector<Vec3>& points, const Tolerance& tolerance);

}  // namespace halfshade
