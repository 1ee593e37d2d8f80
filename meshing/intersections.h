#pragma once

#include "meshing/coplanar.h"
#include "meshing/core/tolerance.h"

#include <array>
#include <vector>

namespace halfshade {

/// For each receiver the straight pieces along which others cut through it, as pairs of points,
/// which are added. What only touches, within the planarity tolerance, does not cut.
std::vector<std::vector<std::array<int, 2>>> find_intersections(
    const std::vector<ReceiverDraft>& drafts, std::vector<Vec3>& points,
    const Tolerance& tolerance);

}  // namespace halfshade
