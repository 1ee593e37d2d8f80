#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// The shaft between two polygons: half-spaces and a box that hold the convex hull of both (Haines
/// and Wallace 1991). The half-spaces are those of the hull's facets that contain an edge of either
/// polygon, at most 64; where polygons have very many edges or lie in each other's plane they may
/// be fewer, and the shaft is then larger than the hull.
struct Shaft {
  struct Side {
    Vec3 normal;       ///< unit length, outwards
    double limit = 0;  ///< normal · x ≤ limit in the hull
  };
  std::vector<Side> sides;
  Vec3 low, high;
  std::vector<Vec3> corners;  ///< of both polygons
  double tolerance = 0;       ///< what reaches in by less only touches the shaft
};

/// Each polygon has one vertex or more; non-convex ones count as their convex hull.
Shaft make_shaft(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance);

/// What reaches into the hull of two polygons by less only touches it: relative to its size, and
/// roundings of coordinates far from the origin.
double shaft_tolerance(std::span<const Vec3> a, std::span<const Vec3> b);

/// Sides that still need a test, one bit each.
using SideMask = std::uint64_t;
SideMask all_sides(const Shaft& shaft);

/// True if the box does not reach into the shaft. Otherwise clears the bits of the sides that the
/// whole box lies within. Conservative: may be false for a box near the shaft's edges.
bool is_outside(const Shaft& shaft, const Vec3& low, const Vec3& high, SideMask& mask);

/// True if the triangle cannot lie between the polygons: it does not reach into the shaft, or both
/// polygons lie on one closed side of its plane, or it has no area. Tests the sides of `mask` only.
bool is_harmless(const Shaft& shaft, const std::array<Vec3, 3>& triangle, SideMask mask);

}  // namespace halfshade
