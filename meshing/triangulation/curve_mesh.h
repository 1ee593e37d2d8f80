#pragma once

#include "meshing/triangulation/planar_mesh.h"

#include <span>
#include <vector>

namespace halfshade {

/// A curve as a polyline that the mesh must have edges along.
struct CurvePolyline {
  std::vector<Vec2> points;  ///< ≥ 2
  int id = 0;                ///< ≥ 0; several polylines may share one
};

struct CurveMeshOptions {
  PlanarMeshOptions quality;  ///< max_triangles ends refinement early, `complete` tells
  double snap = 1e-7;         ///< points and edges closer than this become one, scene units, > 0
  /// Refinement makes no edge shorter than this, scene units, > snap. What is narrower stays as it
  /// is. Of max_length at most a quarter counts.
  double shortest = 1e-3;
};

/// A mesh with edges along curves.
struct CurveMesh {
  PlanarMesh mesh;          ///< constrained_edges: all those on rings, contact lines and curves
  std::vector<bool> is_d0;  ///< [constrained edge] lies on a ring or contact line
  std::vector<int> curve_begin;  ///< [constrained edge] range of `curves`; one more at the end
  std::vector<int> curves;       ///< ids of the curves that run along an edge, sorted
  double deviation = 0;          ///< largest distance of a mesh edge from its curve, scene units
};

/// The constrained Delaunay triangulation of a polygon with holes with edges along its rings,
/// contact lines and curves, of which there may be none, refined for quality by Delaunay refinement
/// (Chew 1993, Ruppert 1995; see curve_mesh.md). Guarantees, for any input:
/// 1. it terminates, with a conforming, positively oriented mesh of the whole polygon;
/// 2. ring vertices stay where they are, also those in the middle of a straight stretch, and points
///    on ring edges lie on them to rounding: the area is that of the polygon to 1e-12;
/// 3. every curve inside the polygon is a chain of edges within `deviation`, which is a few `snap`
///    (curves outside are left out, those that reach over the border are cut there). If
///    thousands of curves in one place do not settle, `snap` is enlarged, in the last resort they
///    are all left out and `mesh.complete` is false;
/// 4. points are at least about `snap` apart, except where ring vertices are closer; no curve
///    crosses another except at a vertex;
/// 5. edges are at most `quality.max_length` long, and angles at least `quality.min_angle`, save
/// near
///    input angles below 24.3 degrees or where it would take edges shorter than `shortest`; length
///    alone divides rings, contact lines and curves into as few equal parts as may be;
/// 6. scaling everything by a power of two scales the mesh exactly, without curves and contacts.
/// Deterministic. Throws Error(contract) for options out of range.
CurveMesh mesh_with_curves(std::span<const Ring> rings, std::span<const Segment2> contacts,
                           std::span<const CurvePolyline> curves, const CurveMeshOptions& options);

}  // namespace halfshade
