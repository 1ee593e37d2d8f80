#pragma once

#include "meshing/coplanar.h"
#include "meshing/core/tolerance.h"

#include <vector>

namespace halfshade {

/// Finds the contact lines of every receiver: the parts of other receivers' edges that lie in its
/// plane and inside it, and where others cut through it; each once, split where they meet. Where
/// one ends on the receiver's boundary, the boundary gets a corner there. May add points where
/// contact lines cross.
void find_contacts(std::vector<ReceiverDraft>& drafts, std::vector<Vec3>& points,
                   const Tolerance& tolerance);

}  // namespace halfshade
