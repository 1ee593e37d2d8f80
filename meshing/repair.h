#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/scene.h"
#include "meshing/core/tolerance.h"

#include <array>
#include <string>
#include <vector>

namespace halfshade {

using Ring = std::vector<Vec2>;
using Segment2 = std::array<Vec2, 2>;

/// A planar polygon with holes, of one material and group, that exchanges light on the side its
/// frame's normal points to.
struct Receiver {
  PlaneFrame frame;         ///< all 2-D coordinates below are in it
  std::vector<Ring> rings;  ///< the outer boundary (counter-clockwise), then the holes (clockwise)
  std::vector<Segment2> contacts;  ///< inner D0 lines: where edges of other receivers lie in the
                                   ///< polygon or others cut through it
  int material = 0;
  int group = 0;
  int plane = 0;           ///< receivers in one plane, facing either way, share this id
  bool back = false;       ///< the back of a two-sided face; its front is a receiver of its own
  std::vector<int> faces;  ///< input faces it is made of; one that was triangulated may repeat
  std::vector<Ring> face_rings;  ///< their boundaries, one an entry of `faces`
};

/// One thing that was put right.
struct Repair {
  enum class Kind {
    degenerate_dropped,  ///< no area
    duplicate_dropped,   ///< the same corners as another face
    non_planar_triangulated,
    coplanar_merged,  ///< neighbours joined into one receiver
    overlap_removed   ///< coplanar faces of different materials covered each other
  };
  Kind kind;
  std::vector<int> faces;  ///< the input faces concerned
  std::string sentence;    ///< for the user, with ids and values
};

/// A scene that everything downstream may rely on.
struct SoundScene {
  std::vector<Receiver> receivers;
  std::vector<Material> materials;  ///< as in the scene
  std::vector<std::string> groups;  ///< as in the scene
  Tolerance tolerance;
  std::vector<Repair> repairs;
};

/// Turns a valid scene into sound receivers:
/// * vertices closer than the tolerance are welded; faces without area and repeated faces are
/// dropped (of
///   two coincident faces that look opposite ways both stay);
/// * polygons off their plane by more than the tolerance are triangulated, so that each piece is
/// planar;
/// * coplanar neighbours of one material and group that look the same way are merged into polygons
/// with
///   holes; where coplanar faces of different materials that look the same way cover each other, an
///   emitter keeps the common part, else the smaller face does (a lamp set flush over a ceiling);
/// * edges of other receivers that lie inside a receiver become its contact lines, and so do the
/// lines along which others cut through it;
/// * two-sided faces become two receivers.
/// Throws Error(invalid_input) if nothing with an area is left, or if a polygon crosses itself so
/// that it has no sound interior. Deterministic.
SoundScene make_sound(const Scene& scene);

/// Area of a receiver in squared scene units.
double area(const Receiver& receiver);

}  // namespace halfshade
