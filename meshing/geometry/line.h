#pragma once

#include "meshing/core/types.h"

#include <algorithm>

namespace halfshade {

/// An infinite straight line.
struct Line3 {
  Vec3 point;
  Vec3 direction;  ///< any length > 0
};

/// A straight piece of an edge: point(s) = from + s (to − from).
struct Span3 {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();

  Vec3 direction() const { return to - from; }
  Vec3 at(double s) const { return from + s * (to - from); }
};

/// Distance of a point from the line that a span lies on.
inline double distance_to_line(const Vec3& p, const Span3& span) {
  const Vec3 along = span.direction().normalized();
  return (p - span.from - along.dot(p - span.from) * along).norm();
}

/// Distance of a point from the span itself, which may have no length.
inline double distance_to_span(const Vec3& p, const Span3& span) {
  const double square = span.direction().squaredNorm();
  const double s =
      square > 0 ? std::clamp(span.direction().dot(p - span.from) / square, 0., 1.) : 0;
  return (span.at(s) - p).norm();
}

/// Whether a point is one of a span's ends, to within `slack` (a length).
inline bool is_end(const Vec3& p, const Span3& span, double slack) {
  return (p - span.from).norm() <= slack || (p - span.to).norm() <= slack;
}

}  // namespace halfshade
