#pragma once

#include "meshing/rays/occluders.h"

#include <vector>

namespace halfshade {

/// Sets of triangles, by index, each of which single precision resolves in coordinates of its own.
/// One set, unless some triangles are tiny and stay together: those smaller than 1/4,096 of the
/// extent of their set that lie, apart from others as small, within 1/1,024 of it are a set of
/// their own, which may be divided again. A room and a far sun are two sets, as are a table and the
/// plain it stands on. At most 64; what would be more stays in the larger set. The indices of a set
/// rise. O(n log n).
std::vector<std::vector<int>> scale_clusters(const TriangleSoup& soup);

}  // namespace halfshade
