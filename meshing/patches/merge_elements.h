#pragma once

#include <span>
#include <vector>

namespace halfshade {

struct ElementMesh;

/// Puts the wholes in place of their parts. A split is undone where all its parts are named, and
/// all of those splits, too, that made the points in the middle of its edges, also on other
/// surfaces: so the mesh stays conforming, and its elements are such as it had before. Elements
/// are named by their place in ordered_faces; throws Error(contract), with nothing done, for
/// others. Returns node of the forest before → node now, −1 for parts that are gone; vertices that
/// are not needed any more go, and the others keep their order.
std::vector<int> merge_parts(ElementMesh& mesh, std::span<const int> elements);

}  // namespace halfshade
