#pragma once

#include "meshing/core/types.h"

#include <optional>
#include <vector>

namespace halfshade {

/// A piece of a straight line or of a conic in a plane, as a rational quadratic Bézier curve:
///   p(s) = ((1−s)² from + 2 s (1−s) weight control + s² to) / ((1−s)² + 2 s (1−s) weight + s²)
/// for s in [0,1]. It turns by less than 180° and lies in the triangle from, control, to.
struct ConicArc {
  Vec2 from = Vec2::Zero(), control = Vec2::Zero(), to = Vec2::Zero();
  double weight = 1;  ///< > 0
  bool is_straight = true;
};

/// A straight piece, with p(s) running at constant speed.
ConicArc straight_arc(const Vec2& from, const Vec2& to);

/// The arc with given ends and directions of its tangents there (both pointing onwards, any
/// length) that passes through `between`. Straight if all points lie on a line to within
/// `flat` (a length). Nothing if no arc that turns by less than 150° does it: split and try again.
std::optional<ConicArc> conic_arc(const Vec2& from, const Vec2& from_tangent, const Vec2& between,
                                  const Vec2& to, const Vec2& to_tangent, double flat);

Vec2 point_at(const ConicArc& arc, double s);
/// Unit tangent, onwards.
Vec2 tangent_at(const ConicArc& arc, double s);
/// The piece between two parameters s0 < s1.
ConicArc part(const ConicArc& arc, double s0, double s1);
/// Length of the chords of a fine subdivision; exact for straight arcs.
double length(const ConicArc& arc);
/// Distance of a point from the arc, correct to about 1e-12 of the arc's size.
double distance(const ConicArc& arc, const Vec2& p);
/// Parameter of a point of the arc that is nearest to p.
double nearest_parameter(const ConicArc& arc, const Vec2& p);

/// Parameters 0 = s_0 < … < s_n = 1 such that the chords between them stay within `deviation`
/// (a length, > 0) of the arc; as few as halving allows, n = 1 for straight arcs.
std::vector<double> flatten(const ConicArc& arc, double deviation);

}  // namespace halfshade
