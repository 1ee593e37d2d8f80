#pragma once

#include "meshing/core/sound_scene.h"

/// What counts as rounding, or as too little to matter, where curves are traced and joined. Sines
/// below which things are parallel are those of the events.
namespace halfshade::margins {

/// Side steps, relative to how far light goes, to the width of a penumbra, and to a rounding of the
/// largest coordinate.
inline constexpr double relative_step = 1e-9;
inline constexpr double step_in_penumbra = 1e-8;
inline constexpr double roundings_per_step = 1e4;

// In side steps:

/// Pieces of curves shorter than this cannot be decided.
inline constexpr double least_steps = 4;
/// What is hidden counts from 1e-15 of the emitter's area on, so that corners are seen to be cut
/// off only at some distance; what lies closer together is told apart by a single step.
inline constexpr double wide_step = 300;
/// Edges shorter than so many call for the narrow step.
inline constexpr double fine_detail = 1e5;
/// Arcs this flat are straight.
inline constexpr double straight_enough = 0.1;

// Relative to what they are a part of:

/// Parameters of a swath, from 0 to 1, that differ by less are one cut: what lies between is too
/// short to be decided, and whether there is anything between is a matter of rounding.
inline constexpr double same_cut = 1e-10;
/// A line passes a triangle clearly if it stays this share of the triangle away from its border.
inline constexpr double clearly_inside = 1e-7;
/// Normals of planes that are farther apart than this (as a difference of unit vectors) belong to
/// different planes: far more than rounding, far less than what a scene can mean.
inline constexpr double same_plane = 1e-7;

// In what rounding needs:

/// Boxes are grown by so much, as far as edges may be off and still meant.
inline constexpr double box_growth = 1e3;

// In tolerances of the repair:

/// Edges count as in the plane of sight if they are within so many times what counts as joined.
inline constexpr double in_plane = 4;
/// Ends of pieces that were cut at each other's ends are at most so far apart.
inline constexpr double joined_ends = 3;

// Of jumps:

/// Contact lines with a smaller jump of the form factor, absolute, are none.
inline constexpr double least_jump = 1e-9;
/// A jump of the slope that is this small a share of what makes it is rounding.
inline constexpr double least_share = 1e-6;

}  // namespace halfshade::margins

namespace halfshade {

struct EmitterScene;
struct SightLine;

/// How far to the sides of a curve it is tested what is seen there: far above rounding, far below
/// the size of anything that light draws there. A length. Where a line of sight ends in a point of
/// a receiver:
double side_step(const Surface& receiver, const EmitterScene& emitter_scene, const SightLine& line,
                 const Vec3& point);
/// and on a line where a receiver touches something.
double side_step(const Surface& receiver);

}  // namespace halfshade
