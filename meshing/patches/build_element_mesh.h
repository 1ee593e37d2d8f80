#pragma once

#include "meshing/patches/shared_edges.h"
#include "meshing/triangulation/curve_mesh.h"

#include <span>

namespace halfshade {

struct ElementMesh;

/// Puts the meshes of all surfaces, one an entry, into one, each triangle a root of the forest.
/// Edges on which only neighbours have points are split there. `curve_order[id]` is the order of
/// the curve with that id; throws Error(contract) for an id without one, and if a mesh is not one.
ElementMesh build_element_mesh(const SoundScene& scene, const SharedEdges& shared,
                               std::span<const CurveMesh> meshes, std::span<const int> curve_order);

}  // namespace halfshade
