#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"
#include "meshing/events/swath.h"
#include "meshing/geometry/flat_tree.h"
#include "meshing/geometry/lines_through.h"

#include <span>
#include <vector>

namespace halfshade {

/// An edge of the scene that can be a silhouette, seen from points of the emitter, and how its
/// faces lie; those in one plane that cancel are left out.
struct SilhouetteEdge {
  struct Face {
    Vec3 normal;    ///< unit length
    int direction;  ///< ±1 as the face runs along the edge
  };
  int id = 0;                          ///< of the opaque scene
  Span3 whole;                         ///< all of it
  Span3 front;                         ///< the part in front of the emitter's plane
  double joined = 0;                   ///< things closer to it than this are meant to be
  int first_face = 0, face_count = 0;  ///< range of EmitterScene::faces
};

/// A vertex of the scene with the edges at it that can be silhouettes.
struct SilhouetteVertex {
  int id = 0;  ///< of the opaque scene
  Vec3 position = Vec3::Zero();
  double height = 0;       ///< above the emitter's plane
  std::vector<int> edges;  ///< into EmitterScene::edges
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

/// The scene as one emitter's events see it, with all that can take part in them: the edges in
/// front of the emitter that can be silhouettes, their vertices, the emitter's own outline.
struct EmitterScene {
  /// Cost grows as n log n with the scene, but for the square of the number of outline pieces.
  /// `among`: surface → whether its edges and vertices are taken; empty: all are.
  EmitterScene(const SoundScene& scene, const OpaqueScene& opaque, int surface,
               const std::vector<bool>& among = {});

  int emitter;  ///< a surface
  PlaneFrame frame;
  double slack;   ///< a length: positions on the emitter closer than this are the same
  double joined;  ///< a length: things closer to the emitter than this are meant to be
  std::vector<std::vector<Vec2>> rings;
  std::vector<Vec2> hull;  ///< of the outer ring, counter-clockwise
  Eigen::AlignedBox2d bounds;
  Bounds box;  ///< of the hull in space, grown by twice the slack
  double area;
  std::vector<SilhouetteEdge> edges;
  std::vector<SilhouetteEdge::Face> faces;  ///< of the edges, one after the other
  std::vector<SilhouetteVertex> vertices;
  std::vector<OutlinePiece> outline;
  std::vector<OutlinePoint> corners;
  FlatTree edge_tree;    ///< over `edges`, the parts in front
  FlatTree vertex_tree;  ///< over `vertices`

  /// All lines that come from the emitter and meet a span, and others.
  LinesThrough lines_through(const Span3& span) const;
  /// False only if the faces at an edge rule out that it is a silhouette for lines in a direction.
  bool may_be_silhouette(const SilhouetteEdge& edge, const Vec3& direction) const;
  /// Whether a point of the plane lies in the emitter or within the slack of its border.
  bool contains(const Vec3& point) const;
};

/// The line that an edge lies on. Error(contract) if there is no such edge: the horizon is none.
Line3 line_of(const EmitterScene& emitter_scene, const OpaqueTopology& opaque, EdgeId edge);

}  // namespace halfshade
