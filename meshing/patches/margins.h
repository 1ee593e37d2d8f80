#pragma once

/// What decisions of this room rest on. For source files of the room.
namespace halfshade::margins {

// Curves. Parts of the surface's size:
// how far a mesh may be off its curves where no tolerance is asked for,
inline constexpr double default_deviation = 1e-4;
// and at least, for jumps without bound.
inline constexpr double least_deviation = 1e-5;
// Part of an element beyond which a polyline would no longer look like its curve.
inline constexpr double largest_deviation = 0.1;
// Snap distance as a part of the largest coordinate: far above the rounding of curves, far below
// what anyone can see; and of the surface's size, so that those that are tiny keep their shape.
inline constexpr double snap_of_magnitude = 1e-7;
inline constexpr double snap_of_surface = 1e-4;
// And of the deviation, where one is asked for.
inline constexpr double snap_of_deviation = 0.05;

// The shortest edge that refinement makes. Parts of the surface's size: with curves, which come
// close to each other everywhere, and without, where strips of 1 : 1000 still get good angles, by
// some 1000 triangles.
inline constexpr double shortest_with_curves = 1.0 / 400;
inline constexpr double shortest_without_curves = 1.0 / 4000;
// Part of the longest edge allowed.
inline constexpr double shortest_of_longest = 1.0 / 8;

// Border lines. Surfaces that share an edge lie apart there by as much as their planes do, but
// never by this share of an edge.
inline constexpr double largest_gap = 0.01;

// Quality, degrees. What refinement with a floor under its edges can do almost everywhere.
inline constexpr double tolerable_angle = 1;
// Between edges that meet at less, refinement cannot keep its promise. Less what rounding takes
// from an equilateral triangle.
inline constexpr double narrow_angle = 60 - 1e-9;

}  // namespace halfshade::margins
