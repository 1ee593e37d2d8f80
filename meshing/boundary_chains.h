#pragma once

#include "meshing/shadow_arrangement.h"

#include <vector>

namespace halfshade {

/// Joins the pieces of an arrangement into closed chains. Keeps its buffers.
class BoundaryChains {
 public:
  std::vector<ArrangedPiece> pieces;  ///< chain after chain; chains without extent are left out
  std::vector<int> ends;
  std::uint64_t signature = 0;
  bool closed = true;  ///< false if pieces are missing, by more than rounding

  void link(const ShadowArrangement& arrangement, const PointView& view);

  void copy(VisiblePart& part) const;
  void copy_ends(VisiblePart& part) const { part.chain_ends.assign(ends.begin(), ends.end()); }

 private:
  void join_places(const ShadowArrangement& arrangement);
  void join_leftovers(const ShadowArrangement& arrangement, const PointView& view);
  void add_chain(const ShadowArrangement& arrangement, const PointView& view, int first);

  std::vector<int> starts_;    // place → a piece that starts there
  std::vector<int> siblings_;  // piece → another that starts where it does
  std::vector<int> next_;      // piece → the piece that follows it
  std::vector<char> is_taken_;
};

}  // namespace halfshade
