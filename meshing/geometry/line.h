#pragma once

#include "meshing/core/types.h"

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

}  // namespace halfshade
