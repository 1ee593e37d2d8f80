#pragma once

#include "meshing/patches/shared_edges.h"
#include "meshing/triangulation/curve_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Points in space that meshes of several surfaces share.
struct SharedPoints {
  /// A mesh edge that others have points on.
  struct Gap {
    std::array<int, 2> edge{};  ///< points of the surface's mesh, sorted
    std::vector<int> points;    ///< the shared points missing, from the first end to the second
  };

  std::vector<Vec3> position;          ///< of each shared point
  std::vector<std::vector<int>> id;    ///< surface, point of its mesh → shared point; −1: none
  std::vector<std::vector<Gap>> gaps;  ///< of each surface, sorted by edge
};

/// Joins the points of meshes that lie at the same place of a shared line; never two of one
/// surface. A point whose triangles would turn over at the common position keeps its own.
SharedPoints shared_points(const SoundScene& scene, const SharedEdges& shared,
                           std::span<const CurveMesh> meshes);

}  // namespace halfshade
