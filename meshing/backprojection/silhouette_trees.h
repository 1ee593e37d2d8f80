#pragma once

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/geometry/flat_tree.h"

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

/// Trees that find the edges which may be silhouettes. Items are edges of the topology.
struct SilhouetteTrees {
  FlatTree closed_edges;          ///< edges whose faces continue each other
  std::vector<NormalCone> cones;  ///< one a node of closed_edges
  FlatTree open_edges;            ///< all others
};

/// O(n log n) in the number of edges.
SilhouetteTrees make_silhouette_trees(const OpaqueTopology& topology);

}  // namespace halfshade
