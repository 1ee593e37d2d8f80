#pragma once

#include "meshing/triangulation/constrained_mesh.h"

#include <cstddef>

namespace halfshade {

struct RefinementLimits {
  double max_length = 0;  ///< scene units; 0: none
  double min_angle = 0;   ///< degrees, at most delaunay_angle
  double shortest = 0;    ///< no edge shorter than this is made, except to keep to max_length; > 0
  std::size_t max_triangles = 0;
};

/// Refines a constrained Delaunay triangulation until no edge is longer than `max_length` and no
/// angle smaller than `min_angle`, save where constraints meet at smaller ones or it would take
/// edges shorter than `shortest`. Parts of a constraint keep its id. False if it ended early, at
/// `max_triangles`. See curve_mesh.md.
bool refine_lazily(ConstrainedMesh& mesh, const RefinementLimits& limits);

}  // namespace halfshade
