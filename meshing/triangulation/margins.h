#pragma once

#include <numbers>

/// What decisions of this room rest on, other than signs. For source files of the room.
namespace halfshade::margins {

// Lengths, as parts of the polygon's size or of its largest coordinate.
// Corners of rings closer than this are one: far above rounding, far below what anyone draws.
inline constexpr double weld_of_size = 1e-13;
// The same in roundings of coordinates, for polygons far from the origin.
inline constexpr double weld_of_coordinates = 32 * 0x1p-53;
// Decisions about snap distances of at least this many roundings are safe in double precision.
inline constexpr double least_snap = 256 * 0x1p-53;
// Curves are clipped to a box this much wider than the rings', so that new ends stay clear of them.
inline constexpr double clip = 1e-3;

// Parts of the longest edge allowed.
// Rounding of a midpoint and of the way back to space must not push an edge over the limit.
inline constexpr double length = 1e-12;
// What `shortest` is held below, so that edges of the right length can be made.
inline constexpr double shortest = 0.25;

// Shapes of triangles.
// Off-centres lie a little nearer than the angle asks for (as in Üngör 2004), lest the new triangle
// is bad by rounding.
inline constexpr double off_centre = 0.95;
// Squares of lengths that are to be no shorter than the shortest edge are larger by this factor.
inline constexpr double not_shorter = 1.0001;
// A point encroaches on a constraint that it sees under a larger angle: cos 120° (Chew's lens).
// Ties count.
inline constexpr double lens_cosine = -0.5 + 1e-9;
// Constraints that meet at less (radians) make a narrow corner: their splits answer each other.
// Not where it is that but for rounding.
inline constexpr double narrow = std::numbers::pi / 3 - 1e-9;
// Round narrow corners constraints are split at this share of the mesh's size times powers of two;
// any would do, but with a simpler one lengths would lie between two powers but for rounding.
inline constexpr double shell_of_size = 0.9;
// Points closer to a line than this share of its length lie on it where it is to be split.
inline constexpr double on_line = 1e-9;
// Constraints that turn by less than this (radians) continue each other.
inline constexpr double straight = 0.01;
// Distances of twins from their corner differ by less than this, relatively.
inline constexpr double twins = 1e-3;

}  // namespace halfshade::margins
