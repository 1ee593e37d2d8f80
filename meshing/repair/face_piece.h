#pragma once

#include "meshing/arrangement/overlay.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"
#include "meshing/repair/weld.h"

#include <vector>

namespace halfshade {

/// A planar polygon with an area: a face or, where that is not planar or crosses itself, a triangle
/// of it.
struct FacePiece {
  int face = 0;
  std::vector<int> loop;  ///< points, counter-clockwise seen from the front
  LocalScale scale;       ///< its magnitude is that of all it hangs together with
};

/// The corners of a loop of points.
std::vector<Vec3> corners_of(const WeldedVertices& vertices, const std::vector<int>& loop);

/// Greatest distance of a corner from the line through the first one and the one farthest from it.
double width_of(const std::vector<Vec3>& polygon);

/// Greatest distance of a corner from a plane.
double deviation_from(const PlaneFrame& frame, const std::vector<Vec3>& polygon);

/// A piece laid out in a plane.
Overlay laid_out(const FacePiece& piece, const PlaneFrame& frame, const WeldedVertices& vertices,
                 const LocalTolerance& tolerance);

/// The triangles of a piece that is laid out in a plane, where its boundary goes round: each looks
/// to the side from which it is gone round counter-clockwise. Adds points where sides cross, in the
/// plane. What is thinner than the tolerance is left out.
std::vector<FacePiece> triangles_of(const FacePiece& piece, const Overlay& layout,
                                    const PlaneFrame& frame, WeldedVertices& vertices,
                                    const LocalTolerance& tolerance);

/// A triangle of a piece, between three points.
FacePiece triangle_of(const FacePiece& piece, int a, int b, int c, const WeldedVertices& vertices);

}  // namespace halfshade
