#pragma once

#include "meshing/core/types.h"

#include <optional>
#include <span>
#include <vector>

namespace halfshade {

/// Twice the signed area of the triangle 0, a, b.
inline double cross_2d(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// How far along the segment ab (0…1) its point nearest to p lies; 0 if it has no length.
double nearest_on_segment(const Vec2& p, const Vec2& a, const Vec2& b);

/// Distance of a point from the segment ab, which may have no length.
double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b);

/// How far from p, in a direction of unit length, the line meets the segment ab: negative behind p,
/// nothing if it passes by or runs along it.
std::optional<double> line_meets_segment(const Vec2& p, const Vec2& direction, const Vec2& a,
                                         const Vec2& b);

/// Distance of a point from the nearest edge of closed rings.
double distance_to_rings(std::span<const std::vector<Vec2>> rings, const Vec2& p);

/// Whether a point lies inside closed rings by the even-odd rule. On an edge, either.
bool is_inside(std::span<const std::vector<Vec2>> rings, const Vec2& p);

}  // namespace halfshade
