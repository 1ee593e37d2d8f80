#pragma once

#include "meshing/core/types.h"

#include <optional>
#include <utility>

namespace halfshade {

/// From where to where a segment lies in a box, as shares of it from 0 to 1; the same twice where
/// it only touches, nothing if it misses the box (Liang and Barsky 1984).
std::optional<std::pair<double, double>> stretch_in_box(const Vec2& from, const Vec2& to,
                                                        const Vec2& low, const Vec2& high);

}  // namespace halfshade
