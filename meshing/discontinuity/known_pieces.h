#pragma once

#include "meshing/events/critical_event.h"
#include "meshing/geometry/line.h"

#include <vector>

namespace halfshade {

/// The pieces of curve that have been found in the plane of one face: all its swaths lie in that
/// plane and may make the same piece.
class KnownPieces {
 public:
  /// Forgets everything unless the source is that of the calls before.
  void use(const CurveSource& source);
  void add(int receiver, const Span3& piece);
  /// Whether one of the pieces on the receiver runs as far as this one does, but for `slack` (a
  /// length). Precondition: all lie on one line.
  bool cover(int receiver, const Span3& piece, double slack) const;

 private:
  struct Known {
    int receiver;
    Span3 span;
  };
  CurveSource source_;
  std::vector<Known> pieces_;
};

}  // namespace halfshade
