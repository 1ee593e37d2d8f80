#pragma once

#include "meshing/core/scene.h"

#include <cstdint>

/// Black scenes of a light and a floor of 4 × 4, in which all light is direct.
namespace halfshade::test {

/// A unit light 2 above the floor, and one to three convex things between: boxes, tetrahedra and
/// polygons, turned at random, that touch nothing.
Scene convex_occluders(std::uint64_t seed);

/// Where light has no smooth pieces: a light that stands on the floor with an edge or a corner,
/// or a little above it, or hangs; things that stand on the floor beside it, or lean on it, or
/// nearly do.
Scene touching_light(std::uint64_t seed);

}  // namespace halfshade::test
