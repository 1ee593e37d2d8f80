#pragma once

#include "meshing/core/sound_scene.h"

#include <cmath>

namespace halfshade {

struct RepairOptions {
  bool contacts = true;  ///< false: none are looked for, so that meshes do not follow them
  double most_contacts = HUGE_VAL;  ///< refuses a scene with more pieces of them,
  double most_surfaces = HUGE_VAL;  ///< and one with more surfaces
};

/// Turns a valid scene into sound surfaces:
/// * vertices closer than the tolerance are welded; faces without area and repeated faces are
/// dropped (of
///   two coincident faces that look opposite ways both stay);
/// * polygons off their plane by more than the tolerance are triangulated, so that each piece is
/// planar, and those that cross themselves are split;
/// * coplanar neighbours of one material and group that look the same way are merged into polygons
/// with
///   holes; where coplanar faces of different materials that look the same way cover each other, an
///   emitter keeps the common part, else the smaller face does (a lamp set flush over a ceiling);
/// * edges of other surfaces that lie inside a surface become its contact lines, and so do the
/// lines along which others cut through it;
/// * two-sided faces become two surfaces.
/// Throws Error(invalid_input) if nothing with an area is left; Error(too_large) if surfaces cut
/// through each other along more lines than can be followed, or than allowed. Deterministic.
SoundScene make_sound(const Scene& scene, const RepairOptions& options = {});

/// The same, but surfaces stand in an order of their own: to the last bit the same for any order of
/// faces and vertices in the file, except that of two faces with the same corners the first stays.
SoundScene make_sound_in_any_order(const Scene& scene, const RepairOptions& options = {});

}  // namespace halfshade
