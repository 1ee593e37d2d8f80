#pragma once

#include "meshing/arrangement/snap_graph.h"
#include "meshing/triangulation/curve_mesh.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace halfshade {

struct CurveInput {
  std::span<const Ring> rings;
  std::span<const Segment2> contacts;
  std::span<const CurvePolyline> curves;
};

/// A polygon and what lies in it as a planar graph. Edges are ids of the graph; one that has been
/// split stands for its parts.
struct CurveDrawing {
  struct Piece {
    Segment2 segment;  ///< as given
    int id;            ///< of its curve
    int edge;
  };
  SnapGraph graph;
  std::vector<std::pair<int, bool>> ring_edges;  ///< and whether the inside ends there
  std::vector<Piece> pieces;                     ///< of curves
};

/// The least snap distance that makes decisions in double precision safe.
double least_safe_snap(std::span<const Ring> rings);

/// Fixed in the graph: rings, and contact lines snapped to them. Free: the curves, as far as they
/// lie near the polygon. Nothing comes back if they do not settle.
std::optional<CurveDrawing> draw_curves(const CurveInput& input, double snap);

}  // namespace halfshade
