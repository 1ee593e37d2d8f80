#pragma once

#include <cstddef>
#include <limits>

/// Every number of this room that stands for rounding, in one place. What they decide is which of
/// two right answers is given, or how much work is done, unless a comment says otherwise.
namespace halfshade::margins {

// Lengths, relative to the largest coordinate.

// What rounding may put a point off a plane that it was computed to lie in: a few roundings each in
// the point, in the plane's origin and in the distance. This is PointView::slack.
inline constexpr double slack = 32 * std::numeric_limits<double>::epsilon();
// Where rounding gives contradictory answers about edges that meet in a point, the vertices are
// scattered by this much: far enough to part the edges, and little enough for the result to stay
// right to 1e-13. So many times as far at each further attempt, and so many attempts in all: the
// last go as far as single precision puts corners that are joined off their surfaces' planes, where
// views along these planes may contradict themselves.
inline constexpr double least_jitter = 0x1p-46;
inline constexpr double jitter_growth = 4;
inline constexpr int most_attempts = 12;

// Lengths, in slacks of the view.

// How far the horizon is raised, so that edges in the plane of the point's surface lie below it.
inline constexpr double raised_horizon = 4;
// Parts thinner than this, eight roundings of a length, are no parts: where occluders abut or touch
// the outline, rounding decides whether there is a gap.
inline constexpr double thinnest_part = 0.25;
// Two scattered edges part by up to 2 √3 times as much as their corners move along an axis.
inline constexpr double jitters_of_a_part = 4;
// An occluder's edge may leave the outline it runs along by so many thinnest parts.
inline constexpr double widest_overlap = 16;
// Arcs that lie within this of one line cross in the middle of what they share.
inline constexpr double same_line = 0.5;
// Ends of pieces that rounding kept from meeting lie within this.
inline constexpr double widest_gap = 1e5;

// Margins of boxes, far above what can go wrong, and little enough to keep the boxes useful.

// The pyramid's sides keep so many blurs clear of the emitter. Boxes are tested with half as much
// again, and shafts that hold several pyramids keep so many slacks clear: whatever rounding does,
// boxes and shafts leave out nothing that the pyramid does not, and results do not depend on them.
inline constexpr double pyramid_margin = 8;
inline constexpr double pyramid_boxes = 1.5;
inline constexpr double shaft_margin = 4 * pyramid_margin;
// Boxes of arcs are enlarged by this share of the outline's size and by so many blurs.
inline constexpr double box_margin = 1e-9;
inline constexpr double blur_margin = 1e5;

// A line counts as passing a box only beyond so many roundings of the products that tell.
inline constexpr double line_slack = 16 * std::numeric_limits<double>::epsilon();

// Sines, cosines and shares.

// Sine of the angle between two arcs' planes below which their crossing is found along the arcs.
inline constexpr double near_parallel = 1e-6;
// Crossings closer than this share of an arc are put in order by their arcs' ends where possible.
inline constexpr double near_tie = 1e-8;
// Sine of the angle to a face's border beyond which a direction does not meet it.
inline constexpr double clearly_inside = 1e-9;
// Corners nearer to the plane through the point than this share of the emitter's distance are not
// projected.
inline constexpr double nearest_image = 1e-4;
// Cosine beyond which the point's normal is its surface's.
inline constexpr double same_normal = 1 - 1e-6;
// How far the square of a unit normal's length may be from 1.
inline constexpr double unit_length = 1e-6;
// Cosine beyond which two edges of a border that follow each other are one.
inline constexpr double same_direction = 1 - 1e-9;
// Stands for 0 where directions are inverted; its inverse is still finite.
inline constexpr double least_slope = 1e-300;
// Below this square of a sine, eight terms of the series of arcsin s / s are exact to rounding.
inline constexpr double small_sine_squared = 2.5e-3;

// Numbers.

// More sides of a pyramid than this cost more in tests than they save in edges.
inline constexpr std::size_t most_sides = 8;

// Of the prepared scene.

// Corners of neighbours lie apart by as much as their planes do, but never by this share of an
// edge.
inline constexpr double largest_joint_gap = 0.01;
// Corners of a quadrilateral that turn by less than this share of the widest may be straight or
// reflex.
inline constexpr double clearly_convex = 1e-6;
// A triangle flatter than this, relative to its longest edge squared, has no trustworthy normal.
inline constexpr double flattest_triangle = 1e-10;
// A cone of normals with a wider sine than this is of no use.
inline constexpr double widest_cone = 0.99;

}  // namespace halfshade::margins
