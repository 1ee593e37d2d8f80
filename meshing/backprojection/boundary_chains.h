#pragma once

#include "meshing/backprojection/shadow_arrangement.h"
#include "meshing/backprojection/visible_part.h"

#include <vector>

namespace halfshade {

/// The size of a set of directions, from its boundary.
struct Extent {
  Vec3 flux = Vec3::Zero();  ///< the integral of the unit directions (Lambert)
  double rounding = 0;       ///< about the size of a set as long but only as wide as rounding
};

/// Joins the pieces of an arrangement into closed chains. Keeps its buffers.
class BoundaryChains {
 public:
  std::vector<ArrangedPiece> pieces;  ///< chain after chain; chains without extent are left out
  std::vector<int> ends;
  std::uint64_t signature = 0;
  bool closed = true;  ///< false if pieces are missing, by more than rounding

  void link(const ShadowArrangement& arrangement, const PointView& view);

  /// What lies outside the chains is no wider than rounding.
  bool fill(const EmitterOutline& outline, const PointView& view) const;

  void copy(VisiblePart& part) const;

 private:
  void join_at_junctions(const ShadowArrangement& arrangement);
  void join_leftovers(const ShadowArrangement& arrangement, const PointView& view);
  void add_chain(const ShadowArrangement& arrangement, const PointView& view, int first);

  Extent total_;               // of all chains
  std::vector<int> starts_;    // junction → a piece that starts there
  std::vector<int> siblings_;  // piece → another that starts where it does
  std::vector<int> next_;      // piece → the piece that follows it
  std::vector<char> is_taken_;
};

}  // namespace halfshade
