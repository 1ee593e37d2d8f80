#pragma once

#include "meshing/repair/clean_faces.h"
#include "meshing/repair/planes.h"

#include <vector>

namespace halfshade {

/// Says in `repairs` which faces that look at each other across a gap, as their own coordinates
/// have it, came into one plane. Cost: n log n for n pieces, and for each pair that lies over each
/// other.
void report_shut_gaps(const Scene& scene, const std::vector<FacePiece>& pieces,
                      const PlaneClasses& classes, std::vector<Repair>& repairs);

/// The same of gaps that were left open, but are within what corners may be off a plane: faces that
/// are meant to be back to back, one in the other's place. Cost: as above, for all that are near
/// each other.
void report_narrow_gaps(const Scene& scene, const std::vector<FacePiece>& pieces,
                        const PlaneClasses& classes, std::vector<Repair>& repairs);

}  // namespace halfshade
