#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"
#include "meshing/events/swath.h"

#include <span>
#include <vector>

namespace halfshade {

/// An edge of the scene and how its faces lie, those in one plane that cancel left out.
struct StageEdge {
  struct Face {
    Vec3 normal;    ///< unit length
    int direction;  ///< ±1 as the face runs along the edge
  };
  int id = 0;   ///< of the opaque scene
  Span3 whole;  ///< all of it
  Span3 front;  ///< the part in front of the emitter's plane
  int first_face = 0, face_count = 0;
};

/// A vertex of the scene with the edges at it that can be silhouettes.
struct StageVertex {
  int id = 0;  ///< of the opaque scene
  Vec3 position = Vec3::Zero();
  double height = 0;       ///< above the emitter's plane
  std::vector<int> edges;  ///< into EmitterStage::edges
};

/// A straight piece of the border of what the emitter shows: an edge of its own, or where something
/// touches or cuts its plane.
struct OutlinePiece {
  Span3 span;
  EdgeId id;
  Feature feature;
};

/// A point of the emitter's plane where such pieces meet or an edge touches it.
struct OutlinePoint {
  Vec3 position = Vec3::Zero();
  std::vector<EdgeId> edges;  ///< what meets there
  Feature feature;
};

/// All that can take part in events of one emitter: silhouette-capable edges in front of it, their
/// vertices, its own outline.
struct EmitterStage {
  EmitterStage(const SoundScene& scene, const OpaqueScene& opaque, int receiver);

  int emitter;
  PlaneFrame frame;
  double slack;   ///< a length: positions closer than this are the same
  double joined;  ///< a length: things closer than this are meant to be
  std::vector<std::vector<Vec2>> rings;
  std::vector<Vec2> hull;  ///< of the outer ring, counter-clockwise
  Eigen::AlignedBox2d bounds;
  double area;
  std::vector<StageEdge> edges;
  std::vector<StageEdge::Face> faces;
  std::vector<StageVertex> vertices;
  std::vector<int> stage_edge;  ///< edge of the opaque scene → into `edges`, or −1
  std::vector<OutlinePiece> outline;
  std::vector<OutlinePoint> corners;

  /// The stage's edge with an id of the opaque scene; −1 if it has none.
  int edge_of(int id) const {
    return static_cast<std::size_t>(id) < stage_edge.size()
               ? stage_edge[static_cast<std::size_t>(id)]
               : -1;
  }
  /// False only if the faces at an edge rule out that it is a silhouette for lines in a direction.
  bool may_be_silhouette(const StageEdge& edge, const Vec3& direction) const;
  /// Whether a point of the plane lies in the emitter or within the slack of its border.
  bool contains(const Vec3& point) const;
};

/// The line that an edge lies on. Error(contract) if there is no such edge: the horizon is none.
Line3 line_of(const EmitterStage& stage, const OpaqueTopology& opaque, EdgeId edge);

/// The convex hull of points in a plane, counter-clockwise.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

}  // namespace halfshade
