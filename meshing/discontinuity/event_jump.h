#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/types.h"
#include "meshing/geometry/line.h"

#include <array>

namespace halfshade {

/// Where light is received: a point, its unit normal, and a unit direction in its plane in which
/// derivatives are taken.
struct ReceivingPoint {
  Vec3 position;
  Vec3 normal;
  Vec3 across;
};

/// Size of the jump of the second derivative of the form factor along `across`, at a point from
/// which three lines meet in one point of the emitter: K C v², where K is the kernel
/// cosθ cosθ'/(π r²), and the triangle between the lines, seen on the emitter, has the area
/// C v² t²/2 at distance t from the event. Any of the lines may be an edge of the emitter. Infinite
/// if two of the lines coincide as seen from the point and the third does not; 0 if all three do.
/// 0, too, if the lines meet below the horizon or the emitter faces away.
double triangle_jump(const ReceivingPoint& at, const PlaneFrame& emitter,
                     const std::array<Line3, 3>& lines);

/// Size of the jump of the third derivative of the form factor along `across`, at a point in whose
/// horizon two lines meet on the emitter: over the triangle between them and the horizon the kernel
/// grows from zero as κ times the height over the horizon. The sign is that of this height on the
/// left. Infinite if the lines coincide as seen from the point; 0 if they meet behind it, or if the
/// emitter faces away.
double horizon_jump(const ReceivingPoint& at, const PlaneFrame& emitter,
                    const std::array<Line3, 2>& lines);

/// What a straight piece of the visible part's boundary adds to the first derivative of the form
/// factor by moving: ∫ K v dl, where v is how fast the piece's image on the emitter moves to the
/// right of the piece, for a point that moves along `across` at unit speed. `from` and `to` are
/// points on the edge that makes it, in the direction of the boundary (visible part on the left
/// seen from the point). 0 for an edge in the emitter's plane. In closed form, correct to rounding;
/// the whole piece must be above the horizon and in front of the emitter.
double boundary_motion(const ReceivingPoint& at, const PlaneFrame& emitter, const Vec3& from,
                       const Vec3& to);

}  // namespace halfshade
