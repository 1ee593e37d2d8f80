#pragma once

#include "meshing/backprojection/opaque_topology.h"

#include <cmath>
#include <vector>

namespace halfshade {

/// On which side of the emitter's plane the vertices of a scene lie.
class VertexHeights {
 public:
  /// Vertices within `slack` of the plane, a length, lie on it.
  VertexHeights(const OpaqueTopology& opaque, const PlaneFrame& emitter, double slack)
      : slack_(slack) {
    for (const Vec3& p : opaque.vertices) height_.push_back(emitter.height(p));
  }

  double height(int vertex) const { return height_[at(vertex)]; }
  bool is_on(int vertex) const { return std::abs(height(vertex)) <= slack_; }
  bool is_in_front(int vertex) const { return height(vertex) > slack_; }
  bool is_behind(int vertex) const { return height(vertex) < -slack_; }

 private:
  std::vector<double> height_;
  double slack_;
};

}  // namespace halfshade
