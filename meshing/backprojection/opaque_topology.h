#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/core/types.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// The opaque polygons of a scene as triangles that share vertices and edges. Vertices that are the
/// same to within the tolerance are one; one that lies on an edge of an outline is part of that
/// outline.
struct OpaqueTopology {
  struct Triangle {
    std::array<int, 3> corner;  ///< into vertices, counter-clockwise on the surface's front
    std::array<int, 3> edge;    ///< [k] from corner k to k + 1
    int surface;
  };
  struct Edge {
    int from, to;              ///< into vertices; from < to
    int first = 0, count = 0;  ///< range of incidences
    double joined = 0;         ///< what is closer to it than this is meant to lie on it
  };
  struct Incidence {
    int triangle;
    int direction;  ///< +1 if the triangle runs along the edge from `from` to `to`, else −1
  };
  /// A vertex of a surface's outline and the number of the ring edge that starts at or runs
  /// through it, rings counted through.
  struct OutlineVertex {
    int vertex;
    int edge;
  };
  /// A surface's plane, and which outlines are its.
  struct OpaqueSurface {
    PlaneFrame frame;
    int first_ring = 0, ring_count = 0;  ///< range of rings
    LocalTolerance tolerance;
    double magnitude = 0;  ///< its largest coordinate
  };
  struct RingRange {
    int first = 0, count = 0;  ///< range of outline
  };

  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;  ///< of triangles; by their ends
  std::vector<Incidence> incidences;
  std::vector<OpaqueSurface> surfaces;  ///< one a surface
  std::vector<RingRange> rings;
  std::vector<OutlineVertex> outline;

  double magnitude = 0;  ///< the largest coordinate

  /// The outline as rings of vertices, T-junctions included.
  std::span<const OutlineVertex> ring(int index) const {
    const RingRange& range = rings[at(index)];
    return {outline.data() + range.first, at(range.count)};
  }
  /// The ends of an edge.
  std::array<Vec3, 2> ends(const Edge& edge) const {
    return {vertices[at(edge.from)], vertices[at(edge.to)]};
  }
};

/// O(n log n) in the number of corners.
OpaqueTopology make_opaque_topology(const SoundScene& scene);

/// The surfaces' ring vertices as points in space, those that are the same joined: of
/// their positions the first by x, y and z is taken. Every vertex that lies on a ring edge becomes
/// part of that ring. Fills vertices, surfaces, rings, outline and magnitude.
void join_outlines(const SoundScene& scene, OpaqueTopology& out);

/// Cuts the outlines into triangles. Fills triangles, except their edges.
void cut_into_triangles(const SoundScene& scene, OpaqueTopology& out);

/// Fills edges, incidences and the triangles' edges.
void connect_triangles(OpaqueTopology& out);

}  // namespace halfshade
