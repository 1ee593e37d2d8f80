#pragma once

#include "meshing/repair/coplanar.h"

#include <cmath>
#include <vector>

namespace halfshade {

/// Finds the contact lines of every surface: the parts of other surfaces' edges that lie in its
/// plane and inside it, and where others cut through it; each once, split where they meet. Where
/// one ends on the surface's boundary, the boundary gets a corner there. May add points where
/// contact lines cross. What lies in a plane follows from the scale of the surface and of that
/// which the edge belongs to. Throws Error(too_large) where so many lines cross that finding it all
/// would take more than about a minute, and where there are more than `most` pieces of them.
void find_contacts(std::vector<SurfaceDraft>& drafts, std::vector<Vec3>& points,
                   double most = HUGE_VAL);

}  // namespace halfshade
