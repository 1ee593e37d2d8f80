#pragma once

#include "meshing/discontinuity/discontinuity.h"

#include <span>
#include <vector>

namespace halfshade {

/// A curve on a stretch that several may share.
struct StackedCurve {
  int curve = 0;          ///< number in some array
  bool reversed = false;  ///< runs against the direction of the stretch
};

/// A piece of the result of merging.
struct MergedCurve {
  int place = 0;  ///< number of the curve whose place it takes
  DiscontinuityCurve curve;
};

/// What curves that lie on top of each other have together on a stretch `arc` of theirs, without
/// the jump. At least one member.
DiscontinuityCurve stack(std::span<const DiscontinuityCurve> curves,
                         std::span<const StackedCurve> members, const ConicArc& arc);

/// Whether two pieces are the same but for their arcs.
bool alike(const DiscontinuityCurve& a, const DiscontinuityCurve& b);

/// Merge the straight ones, or the conic arcs, among the curves of one receiver and emitter, given
/// by their numbers. Append all pieces that are left of them; return how many lay on others.
std::size_t merge_straight(std::span<const DiscontinuityCurve> curves, std::span<const int> which,
                           double tolerance, std::vector<MergedCurve>& merged);
std::size_t merge_conics(std::span<const DiscontinuityCurve> curves, std::span<const int> which,
                         double tolerance, std::vector<MergedCurve>& merged);

}  // namespace halfshade
