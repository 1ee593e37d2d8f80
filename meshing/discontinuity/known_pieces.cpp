#include "meshing/discontinuity/known_pieces.h"

#include <algorithm>

namespace halfshade {

void KnownPieces::use(const CurveSource& source) {
  if (source == source_) return;
  source_ = source;
  pieces_.clear();
}

void KnownPieces::add(int receiver, const Span3& piece) { pieces_.push_back({receiver, piece}); }

bool KnownPieces::cover(int receiver, const Span3& piece, double slack) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Known& known) {
    if (known.receiver != receiver) return false;
    const Vec3 along = known.span.direction().normalized();
    const double length = known.span.direction().norm();
    const auto is_covered = [&](const Vec3& p) {
      const double t = along.dot(p - known.span.from);
      return t >= -slack && t <= length + slack;
    };
    return is_covered(piece.from) && is_covered(piece.to);
  });
}

}  // namespace halfshade
