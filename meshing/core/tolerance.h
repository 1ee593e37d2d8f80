#pragma once

#include "meshing/core/scene.h"

#include <span>

namespace halfshade {

/// How large the numbers and the things are that a decision is about. What is far away or elsewhere
/// has no part in it.
struct LocalScale {
  double magnitude = 0;  ///< the largest coordinate, absolute: what rounding is relative to
  double size = 0;       ///< the diameter of the thing; of several, of the smallest
  double rounding = 0;   ///< how far apart digits of a file may have moved two such things that
                         ///< are in one plane, of what is moved most

  auto operator<=>(const LocalScale&) const = default;
};

/// Of a polygon or any other set of points, at least one: magnitude, and diagonal of the bounding
/// box.
LocalScale scale_of(std::span<const Vec3> points);

/// Of two things together.
LocalScale joint_scale(const LocalScale& a, const LocalScale& b);

/// Lengths below which parts of things of one scale count as one. Topological decisions (which
/// side, do they cross) are made by exact predicates, not by these.
struct LocalTolerance {
  double length = 0;     ///< points closer than this are the same point
  double planarity = 0;  ///< a polygon deviating less than this from its plane is planar; ≥ length
};

/// Files carry five to nine digits, so the decimal rounding of a coordinate must not bend a polygon
/// (1e-6 of the magnitude, or what its digits tell); distinct points are a billionth of it apart.
/// But nothing is moved by a noticeable part of its own size, however large its coordinates are,
/// nor is anything asked of doubles that they do not hold.
LocalTolerance tolerance_of(const LocalScale& scale);

}  // namespace halfshade
