#pragma once

#include <span>

namespace halfshade {

struct ElementMesh;

/// Splits each named element into four at its edge midpoints. An element with a split edge also has
/// its longest edge split, and so do the twins of split edges on other surfaces (red–green–blue
/// refinement; Carstensen 2004). Elements are named by their place in ordered_faces; throws
/// Error(contract), with nothing done, for others.
void split_in_four(ElementMesh& mesh, std::span<const int> elements);

/// Bisects each named element at its longest edge, with the same closure (Rivara 1984).
void bisect(ElementMesh& mesh, std::span<const int> elements);

}  // namespace halfshade
