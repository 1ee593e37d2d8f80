#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstdint>

namespace halfshade {

/// What random numbers of a triangle begin with. It follows from where the triangle lies, as seen
/// from the origin, and where it looks, and from nothing else: it is the same in any unit of length
/// but for one in a million triangles, and whatever there is besides. Triangles much closer to each
/// other than 1e-7 of their distance from the origin may have the same.
std::uint64_t triangle_key(const std::array<Vec3, 3>& corners);

}  // namespace halfshade
