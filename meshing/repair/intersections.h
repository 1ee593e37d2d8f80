#pragma once

#include "meshing/repair/coplanar.h"

#include <array>
#include <vector>

namespace halfshade {

/// For each surface the straight pieces along which others cut through it, as pairs of points,
/// which are added. What only touches, within the planarity tolerance of the two, does not cut.
/// Throws Error(too_large) where there are more than `most` of them, or half a million.
std::vector<std::vector<std::array<int, 2>>> find_intersections(
    const std::vector<SurfaceDraft>& drafts, std::vector<Vec3>& points, double most);

}  // namespace halfshade
