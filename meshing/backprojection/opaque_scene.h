#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/geometry/flat_tree.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// What every normal below a node of the edge tree has in common: it lies within an angle of an
/// axis. Normals count with a sign such that faces which continue each other look the same way.
struct NormalCone {
  Vec3 axis = Vec3::Zero();  ///< zero: nothing is known
  double cosine = -1, sine = 0;
  double thickness = 0;  ///< half the extent of the vertices along the axis, about `centre`
  double radius = 0;     ///< of the vertices about `centre`
  Vec3 centre = Vec3::Zero();
};

struct OpaqueScene::Impl {
  struct Triangle {
    std::array<int, 3> corner;  ///< into vertices, counter-clockwise on the surface's front
    std::array<int, 3> edge;    ///< [k] from corner k to k + 1
    int surface;
  };
  struct Edge {
    int from, to;              ///< into vertices; from < to
    int first = 0, count = 0;  ///< range of incidences
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
  /// Surfaces' planes, and which outlines are theirs.
  struct OpaqueSurface {
    PlaneFrame frame;
    int first_ring = 0, ring_count = 0;  ///< range of rings
  };
  struct RingRange {
    int first = 0, count = 0;  ///< range of outline
  };

  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<Incidence> incidences;
  std::vector<OpaqueSurface> surfaces;  ///< one a surface
  std::vector<RingRange> rings;
  std::vector<OutlineVertex> outline;

  FlatTree closed_edges;          ///< edges whose faces continue each other; items index `edges`
  std::vector<NormalCone> cones;  ///< one a node of closed_edges
  FlatTree open_edges;            ///< all others
  FlatTree faces;                 ///< items index `triangles`

  Tolerance tolerance;
  double magnitude = 0;  ///< the largest coordinate

  /// The outline as rings of vertices, T-junctions included.
  std::span<const OutlineVertex> ring(int index) const {
    const RingRange& range = rings[static_cast<std::size_t>(index)];
    return {outline.data() + range.first, static_cast<std::size_t>(range.count)};
  }
};

/// The surfaces' ring vertices as points in space, those that are the same joined: each keeps the
/// position of the first. Every vertex that lies on a ring edge becomes part of that ring. Fills
/// vertices, surfaces, rings and outline.
void join_outlines(const SoundScene& scene, OpaqueScene::Impl& out);

/// Cuts the outlines into triangles. Fills triangles, except their edges.
void cut_into_triangles(const SoundScene& scene, OpaqueScene::Impl& out);

}  // namespace halfshade
