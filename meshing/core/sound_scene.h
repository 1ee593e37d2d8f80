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

/// A planar polygon with holes, of one material, paint and group, that exchanges light on the side
/// its frame's normal points to.
struct Surface {
  PlaneFrame frame;         ///< all 2-D coordinates below are in it
  std::vector<Ring> rings;  ///< the outer boundary (counter-clockwise), then the holes (clockwise)
  std::vector<Segment2> contacts;  ///< inner D0 lines: where edges of other surfaces lie in the
                                   ///< polygon or others cut through it
  LocalScale scale;                ///< of all that hangs together with it, and its own size
  int material = 0;
  int group = 0;
  int paint = -1;          ///< multiplies the material's reflectance; −1: none
  int plane = 0;           ///< surfaces in one plane, facing either way, share this id
  bool back = false;       ///< the back of a two-sided face; its front is a surface of its own
  std::vector<int> faces;  ///< input faces it is made of; one that was triangulated may repeat
  std::vector<Ring> face_rings;  ///< their boundaries, one an entry of `faces`
};

/// One thing that was put right, as data; repair_sentence.h makes a sentence of it.
struct Repair {
  enum class Kind {
    degenerate_dropped,       ///< no area; size: the width below which that is so
    duplicate_dropped,        ///< the first face has the same corners as the second
    non_planar_triangulated,  ///< size: how far corners are off the plane
    crossed_split,            ///< its boundary crosses itself: triangles took its place
    coplanar_merged,          ///< neighbours joined into one surface
    overlap_removed,  ///< coplanar faces of different materials covered each other: the first keeps
                      ///< the common part; size: its area
    gap_shut,   ///< two that look at each other count as touching; size: how far apart they are
    narrow_gap  ///< the same, but light that enters the gap between them is followed
  };
  Kind kind;
  std::vector<int> faces;  ///< the input faces concerned
  double size = 0;         ///< a length or an area in scene units, 0 where there is none
};

/// A scene that everything downstream may rely on.
struct SoundScene {
  std::vector<Surface> surfaces;
  std::vector<Material> materials;  ///< as in the scene
  std::vector<Paint> paints;        ///< as in the scene
  std::vector<std::string> groups;  ///< as in the scene
  std::vector<int> face_lines;      ///< Face::line of every input face
  double diagonal = 0;              ///< of the bounding box of all input faces, scene units
  std::vector<Repair> repairs;
};

/// Lengths below which parts of a surface, or of two of them, count as one.
LocalTolerance tolerance_of(const Surface& surface);
LocalTolerance tolerance_of(const Surface& a, const Surface& b);

/// Reflectance at a point of a surface.
Rgb reflectance_at(const SoundScene& scene, const Surface& surface, const Vec3& position);

/// Area of a surface in squared scene units.
double area(const Surface& surface);

/// Diagonal of a surface's bounding rectangle in its frame.
double size_of(const Surface& surface);

}  // namespace halfshade
