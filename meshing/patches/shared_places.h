#pragma once

#include "meshing/patches/shared_edges.h"
#include "meshing/triangulation/curve_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Places in space that points of several surfaces' meshes share.
struct SharedPlaces {
  /// A mesh edge that others have points on.
  struct Gap {
    std::array<int, 2> edge{};  ///< points of the surface's mesh, sorted
    std::vector<int> places;    ///< those missing, from the first end to the second
  };

  std::vector<Vec3> position;           ///< of each place
  std::vector<std::vector<int>> place;  ///< surface, point → place; −1: not on a shared line
  std::vector<std::vector<Gap>> gaps;   ///< of each surface, sorted by edge
};

/// Joins the points of meshes that lie at the same place of a shared line; never two of one
/// surface. A point whose triangles would turn over at the common place keeps its own.
SharedPlaces shared_places(const SoundScene& scene, const SharedEdges& shared,
                           std::span<const CurveMesh> meshes);

}  // namespace halfshade
