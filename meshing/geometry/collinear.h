#pragma once

#include "meshing/core/types.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Groups segments that lie on the same line, whatever their direction and wherever on it: for each
/// segment the number of the longest of its group. The ends of every segment are within `tolerance`
/// (a length, well above rounding) of the line through the longest; of several lines that would do
/// it gets the nearest. Segments shorter than 8 tolerances, whose direction says little, stay on
/// their own. O(n log n) unless many lines meet in a point; deterministic.
std::vector<int> collinear_groups(std::span<const std::array<Vec2, 2>> segments, double tolerance);

}  // namespace halfshade
