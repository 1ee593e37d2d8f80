#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"

#include <array>
#include <vector>

namespace halfshade {

/// The cells into which elements part space: light that is in one never gets into another.
struct SpaceCells {
  /// Element → the cell before its front, and the one behind it.
  std::vector<std::array<int, 2>> of_side;
  /// Cell → it is bounded, and only fronts look into it: whatever its elements send, they receive.
  std::vector<bool> closed;
  /// Cell → if it is closed, the area of the gaps that surfaces leave which count as meeting, for
  /// they are no farther apart than their planes are off their corners. Those that rounding
  /// explains are left out.
  std::vector<double> gaps;
  /// Cell → the surface whose back swallows light in it; −1 if there is none.
  std::vector<int> swallowing;
  int outside = 0;  ///< the cell that extends to infinity

  int count() const { return static_cast<int>(closed.size()); }
  int before(int element) const { return of_side[at(element)][0]; }
};

/// Finds them from how elements meet at edges, in whatever way they meet there: a surface with a
/// free edge has the same cell on both sides, and the narrowest gap joins two cells. Elements must
/// meet end to end, as those of PatchMesh and DiscontinuityMesh do. What sees past each other in
/// one plane (see Segment) does so here. Cost: n log n for n elements, and n for every body that
/// touches no other.
SpaceCells find_cells(const SoundScene& scene, const ElementTable& elements);

}  // namespace halfshade
