#pragma once

#include "meshing/discontinuity/discontinuity.h"

#include <span>
#include <vector>

namespace halfshade {

/// How the visible part's boundary differs between two sides of a curve, as far as a group of edges
/// is concerned.
struct EventEvidence {
  bool differs = false;
  /// What the difference is made of; signs are those of the second derivative's jump from right to
  /// left. Empty where edges that line up appear or vanish at once.
  std::vector<EdgeTriple> triples;
};

/// What `point` sees on one side of a curve.
struct SideView {
  Vec3 point;
  const VisiblePart& part;
};

/// Compares the places where one edge of `group` (sorted) follows another along the boundary.
EventEvidence compare_sides(const SideView& left, const SideView& right,
                            std::span<const EdgeId> group);

}  // namespace halfshade
