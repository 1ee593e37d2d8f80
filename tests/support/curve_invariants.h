#pragma once

#include "meshing/triangulation/curve_mesh.h"
#include "tests/support/mesh_invariants.h"

#include <array>
#include <vector>

/// What must hold of every mesh with curves, checked without using anything that made it but the
/// distances of planar.h, which have tests of their own.
namespace halfshade::test {

inline Segment2 place_of(const PlanarMesh& mesh, const std::array<int, 2>& edge) {
  return {mesh.points[static_cast<std::size_t>(edge[0])],
          mesh.points[static_cast<std::size_t>(edge[1])]};
}

/// The arrays belong together, the D0 edges make up rings and contact lines, and every ring vertex
/// is a vertex of the mesh.
void expect_sound(const CurveMesh& curved, const std::vector<Ring>& rings,
                  const std::vector<Segment2>& contacts = {});

/// Edges with a line's id lie along it, and together they cover what of it lies inside.
void expect_follows(const CurveMesh& curved, const std::vector<Ring>& rings,
                    const std::vector<CurvePolyline>& lines, double snap);

/// The number of parts that the constrained edges cut a mesh into.
int region_count(const CurveMesh& curved);

}  // namespace halfshade::test
