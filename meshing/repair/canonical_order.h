#pragma once

#include "meshing/core/scene.h"

#include <vector>

namespace halfshade {

/// A scene with the same faces in an order of their own.
struct OrderedScene {
  Scene scene;
  std::vector<int> face;  ///< of the scene it was made from, for each of its faces
};

/// The same for any order of faces and vertices, and any corner that a face begins with: vertices
/// rise with x, y and z, and those in one place are one; faces begin with their first vertex and
/// rise with their vertices. Only faces with the same corners keep the order they have. In another
/// unit of length the order is the same, but for vertices that differ by rounding alone. The scene
/// must be valid.
OrderedScene in_canonical_order(const Scene& scene);

}  // namespace halfshade
