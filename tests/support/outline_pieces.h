#pragma once

#include "meshing/events/emitter_scene.h"

/// What tests of emitter scenes ask of the pieces of an outline.
namespace halfshade::test {

inline bool is_same(const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-9; }

inline bool is_own(const OutlinePiece& piece) {
  return piece.id.kind == EdgeId::Kind::emitter_edge;
}
inline bool is_cut(const OutlinePiece& piece) { return piece.id.kind == EdgeId::Kind::cut; }

/// Length of the pieces that `keep` is true of.
template <class Keep>
double outline_length(const EmitterScene& emitter_scene, const Keep& keep) {
  double sum = 0;
  for (const OutlinePiece& piece : emitter_scene.outline)
    if (keep(piece)) sum += piece.span.direction().norm();
  return sum;
}

}  // namespace halfshade::test
