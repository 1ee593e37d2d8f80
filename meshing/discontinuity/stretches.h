#pragma once

#include "meshing/core/sound_scene.h"

#include <array>
#include <vector>

namespace halfshade {

/// Parameters along the line origin + t·along between which it is inside a receiver, in its frame:
/// pairs in order.
std::vector<std::array<double, 2>> stretches(const Surface& receiver, const Vec2& origin,
                                             const Vec2& along);

}  // namespace halfshade
