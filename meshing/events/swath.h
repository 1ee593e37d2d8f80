#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/events/critical_event.h"
#include "meshing/events/quadric_events.h"
#include "meshing/geometry/line.h"
#include "meshing/geometry/lines_through.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace halfshade {

/// A one-parameter family of lines of sight that could all be critical: the lines through an apex
/// and the points of a base, or those that meet three skew edges. The parameter t in [0,1] is that
/// of the point on the base, or on the first of the three edges.
struct Swath {
  CurveSource source;
  std::vector<EdgeId> group;  ///< edges whose images change their order here, sorted
  /// Edges of the EmitterScene that must be silhouettes for every line, −1: none; and a vertex of
  /// it with at least two edges that are, or −1.
  std::array<int, 3> silhouettes = {-1, -1, -1};
  int corner = -1;
  bool ends_on_outline = false;     ///< its lines start on the emitter's border, not inside
  bool may_be_first_order = false;  ///< two or more edges of the group lie in its plane
  bool is_planar = true;
  Vec3 apex = Vec3::Zero();
  Span3 base;                    ///< of a planar swath
  std::optional<Span3> second;   ///< in its plane: another edge that its lines must meet
  std::array<Span3, 3> edges{};  ///< of the others
  LineFamily family;             ///< the lines that meet them
};

/// One line of a swath, directed away from the emitter.
struct SightLine {
  Vec3 start;      ///< on the emitter's plane
  Vec3 last;       ///< the farthest of the points that make it
  Vec3 direction;  ///< unit length
};

/// The line with parameter t; nothing if it does not come from the emitter's plane, or if it misses
/// one of the edges.
std::optional<SightLine> line_at(const Swath& swath, const PlaneFrame& emitter, double t);

/// Parameters in (0,1) at which the line can meet an edge or pass its ends: all of them, and
/// perhaps some at which it does not. `slack`: a length below which an edge lies in the plane of a
/// planar swath.
void critical_parameters(const Swath& swath, const Span3& edge, double slack,
                         std::vector<double>& parameters);

/// Parameters in (0,1) at which the lines begin or end to meet all edges that make the swath: where
/// they pass an end of the second or third.
void own_limits(const Swath& swath, std::vector<double>& parameters);

/// Parameters in (0,1) at which the line runs along a plane with a normal.
void grazing_parameters(const Swath& swath, const Vec3& normal, std::vector<double>& parameters);

/// Parameters in (0,1) at which one of the features that make the swath lies on a plane.
void feature_parameters(const Swath& swath, const Vec3& point, const Vec3& normal,
                        std::vector<double>& parameters);

/// Unit normal of the plane of a planar swath.
Vec3 plane_normal(const Swath& swath);

/// What contains the lines with parameters in a range: all that run through two boxes, where they
/// leave two of the features, and of a planar swath those in its plane.
struct SwathBounds {
  LinesThrough lines;
  Vec3 normal = Vec3::Zero();  ///< of the plane of a planar swath, unit length; else zero
  Vec3 point = Vec3::Zero();   ///< of that plane

  /// False only if no line of the swath meets the box; `slack` is added to the box.
  bool may_meet(const Bounds& box, double slack) const {
    return std::abs(normal.dot(box.centre() - point)) <=
               normal.cwiseAbs().dot(box.half_size()) + slack &&
           lines.may_meet(box, slack);
  }
};
/// Precondition: no own limit of the swath lies between t0 and t1.
SwathBounds bounds_of(const Swath& swath, double t0, double t1);

/// A swath through three edges, no two of which lie in a plane.
void set_edges(Swath& swath, const std::array<Span3, 3>& edges);

/// Where a line of the swath meets a plane, and the tangent of the curve that these points form
/// (not of unit length; zero where it cannot be told).
struct Trace {
  Vec3 point, tangent;
};
std::optional<Trace> trace_at(const Swath& swath, const PlaneFrame& plane, double t);

}  // namespace halfshade
