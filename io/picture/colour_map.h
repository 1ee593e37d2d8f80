#pragma once

#include "meshing/core/types.h"

#include <vector>

namespace halfshade {

enum class ColourMap {
  sequential,  ///< dark blue, green, yellow: lightness rises evenly
  diverging    ///< blue, light grey, red: what differs from the middle stands out
};

/// Colours of numbers. Sequential: viridis (van der Walt and Smith 2015), by thirteen of its
/// colours and straight lines between them in CIELAB, so that equal steps look equal. Diverging:
/// from cool to warm through Msh, the polar form of CIELAB (Moreland 2009).
class ColourTable {
 public:
  explicit ColourTable(ColourMap map);

  /// The linear colour at a share of the way, clamped to [0, 1]; grey if that is not a number.
  Rgb at(double share) const;

 private:
  std::vector<Rgb> colours_;
};

}  // namespace halfshade
