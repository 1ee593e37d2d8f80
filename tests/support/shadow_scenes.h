#pragma once

#include "tests/support/scene_maker.h"

/// Scenes of one square light (or nearly) whose occluders make every kind of shadow line.
namespace halfshade::test {

/// Bars of bars.md, `count` each way.
SoundScene bars(int count);
/// Those of skew_bars.md: an umbra that ends in a conic.
SceneMaker skew_bars_maker();
/// A triangle below the light whose corner (.9, .2, 1) and edge to (.2, .7, 1) make vertex–edge
/// lines on the floor through (2.3, .4) and (.74, .3).
SoundScene one_triangle();
/// Three narrow triangles, each with an edge of three skew lines that meet others through the
/// light's inside: lines of three edges of which none is the light's.
SoundScene three_skew_slats();
/// The plane y = .05 of the box's side cuts the light: the silhouette seen from the floor goes
/// over from one edge to another on the line through (2.5, .05).
SoundScene face_plane();
SoundScene boxes_on_floor();
SoundScene stacked_boxes();
SoundScene sphere_of_triangles();
/// A box without a lid, of two-sided sheets, with a post inside.
SoundScene open_box();
/// A wall with a window in front of a light.
SoundScene window_in_a_sheet();
/// A closed room: every wall is a surface, and the plane of the light cuts none.
SoundScene closed_room();

}  // namespace halfshade::test
