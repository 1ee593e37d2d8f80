#pragma once

#include "meshing/core/scene.h"

#include <vector>

namespace halfshade {

/// Vertices that are the same point, found once.
struct WeldedVertices {
  std::vector<Vec3> points;
  std::vector<int> of_vertex;  ///< vertex → point; −1 for vertices no face uses
  /// Point → the largest coordinate of all that faces connect it with: what hangs together was
  /// rounded together, also near the origin.
  std::vector<double> magnitude;
};

/// Welds vertices that are the same point as far as their coordinates and the smallest of the faces
/// at them can tell (see tolerance_of): each becomes the first one near it.
WeldedVertices weld(const Scene& scene);

}  // namespace halfshade
