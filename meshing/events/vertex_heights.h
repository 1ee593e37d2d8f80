#pragma once

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {

/// On which side of the emitter's plane the vertices of a scene lie.
class VertexHeights {
 public:
  /// Vertices within `slack` of the plane, a length, lie on it; so do those that may by rounding of
  /// their own.
  VertexHeights(const OpaqueTopology& opaque, const PlaneFrame& emitter, double slack) {
    for (const Vec3& p : opaque.vertices) {
      height_.push_back(emitter.height(p));
      slack_.push_back(std::max(slack, margins::slack_at(p)));
    }
  }

  double height(int vertex) const { return height_[at(vertex)]; }
  bool is_on(int vertex) const { return std::abs(height(vertex)) <= slack_[at(vertex)]; }
  bool is_in_front(int vertex) const { return height(vertex) > slack_[at(vertex)]; }
  bool is_behind(int vertex) const { return height(vertex) < -slack_[at(vertex)]; }

 private:
  std::vector<double> height_, slack_;
};

}  // namespace halfshade
